// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_EXACT_BOX_MEAN_H_
#define FLATLIGHT_CORE_PLANE_EXACT_BOX_MEAN_H_

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/vec.h"
#include "core/scene/spectrum.h"

namespace flatlight {

// A mean over a box, and an estimate of how far it may be from the truth.
struct BoxMean {
  Spectrum value;
  Spectrum error;
};

// The mean over a box of a function times a weight: at(point) is a Spectrum, weigh(center, size) the weight's mean over
// a cell. Cells in which the function is not nearly linear are halved until their errors are below a tolerance
// together, as far as kMostDepth goes. A cell's error comes from how far its middle and its corners are from linear:
// it covers a step along a line, for that parts a corner from the others. What is narrower than a cell may be missed.
template <typename At, typename Weigh>
class BoxQuadrature {
 public:
  static constexpr int kMostDepth = 6;

  BoxQuadrature(At at, Weigh weigh, int channels) : at_(std::move(at)), weigh_(std::move(weigh)), channels_(channels) {}

  BoxMean Mean(Point2 center, Vector2 box, const Spectrum& tolerance) {
    mean_ = {};
    tolerance_ = tolerance;
    // Boxes whose corners lie on walls are common: what is sampled lies inside.
    const Vector2 inner = kInside * box;
    Cell cell{center, box, inner, at_(center), {}};
    for (int i = 0; i < 4; ++i) cell.corner[i] = at_(center + Vector2{SideX(i) * inner.x, SideY(i) * inner.y});
    Add(cell, 0, 1, nullptr);
    return mean_;
  }

 private:
  static constexpr double kInside = 1 - 1e-6;
  // Of a smooth function halving takes three quarters of what bends. What is left is then of the fourth degree at most,
  // where the rule is off by 2/9 of it (x^2 y^2).
  static constexpr double kSmooth = 0.35;
  static constexpr double kSmoothShare = 0.25;

  // The values in the middle and at the corners (-x -y, +x -y, -x +y, +x +y) of the sampled part.
  struct Cell {
    Point2 center;
    Vector2 box;
    Vector2 inner;
    Spectrum middle;
    Spectrum corner[4];
  };
  static double SideX(int corner) { return corner % 2 == 0 ? -0.5 : 0.5; }
  static double SideY(int corner) { return corner / 2 == 0 ? -0.5 : 0.5; }

  void Add(const Cell& cell, int depth, double share, const Spectrum* bent_before) {
    const double weight = weigh_(cell.center, cell.box);
    Spectrum bent, spread;
    bool smooth = bent_before != nullptr;
    for (int c = 0; c < channels_; ++c) {
      const double f = cell.middle[c];
      const Spectrum* at = cell.corner;
      bent[c] = 0.5 * std::max(std::abs(at[0][c] + at[3][c] - 2 * f), std::abs(at[1][c] + at[2][c] - 2 * f));
      spread[c] =
          std::max({at[0][c], at[1][c], at[2][c], at[3][c], f}) - std::min({at[0][c], at[1][c], at[2][c], at[3][c], f});
      smooth = smooth && bent[c] <= kSmooth * (*bent_before)[c];
    }
    const double part = smooth ? kSmoothShare : 1;
    // A step runs through about 2^depth of the cells of a depth, so that theirs make up the tolerance.
    const double allowance = std::ldexp(1.0, depth);
    bool good = true;
    for (int c = 0; c < channels_; ++c) good = good && part * weight * bent[c] <= allowance * tolerance_[c];
    if (!good && depth < kMostDepth) return Split(cell, depth, share, bent);
    for (int c = 0; c < channels_; ++c) {
      // Right for all polynomials of the third degree.
      const double corners = cell.corner[0][c] + cell.corner[1][c] + cell.corner[2][c] + cell.corner[3][c];
      mean_.value[c] += share * weight * (2 * cell.middle[c] / 3 + corners / 12);
      mean_.error[c] += share * weight * (good ? part * bent[c] : spread[c]);
    }
  }

  void Split(const Cell& cell, int depth, double share, const Spectrum& bent) {
    const auto at = [&](double x, double y) { return at_(cell.center + Vector2{x * cell.inner.x, y * cell.inner.y}); };
    const Spectrum low = at(0, -0.5), high = at(0, 0.5), left = at(-0.5, 0), right = at(0.5, 0);
    const Spectrum corners[4][4] = {{cell.corner[0], low, left, cell.middle},
                                    {low, cell.corner[1], cell.middle, right},
                                    {left, cell.middle, cell.corner[2], high},
                                    {cell.middle, right, high, cell.corner[3]}};
    for (int i = 0; i < 4; ++i) {
      const Vector2 aside{0.5 * SideX(i) * cell.inner.x, 0.5 * SideY(i) * cell.inner.y};
      Cell child{cell.center + aside, 0.5 * cell.box, 0.5 * cell.inner, at_(cell.center + aside), {}};
      std::copy(std::begin(corners[i]), std::end(corners[i]), child.corner);
      Add(child, depth + 1, 0.25 * share, &bent);
    }
  }

  At at_;
  Weigh weigh_;
  int channels_;
  Spectrum tolerance_;
  BoxMean mean_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_BOX_MEAN_H_
