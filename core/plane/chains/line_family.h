// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_LINE_FAMILY_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_LINE_FAMILY_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>

#include "core/math/bernstein.h"
#include "core/math/vec.h"

namespace flatlight {

// A line with a direction: all points p with Cross(direction, p) = moment.
struct DirectedLine {
  Vector2 direction;  // Unit.
  double moment = 0;
};

// How well families follow their lines.
struct LineFit {
  double tolerance = 1e-11;     // Of directions and moments.
  double least_part = 0x1p-20;  // Of the whole; shorter pieces are not made smoother.
  // By the number of a line: one whose number differs by so much is as good. Without it none is: where lines turn fast,
  // rounding alone may then ask for pieces without end.
  std::function<double(double)> shift;
};

// Lines that depend smoothly on a number between begin and end.
struct LineFamily {
  // Neighbouring families overlap by so much on either side, so that no line between them is lost by rounding.
  static constexpr double kOverlap = 1e-12;

  double begin = 0;
  double end = 1;
  Bernstein x, y, moment;

  // How far a point lies to the left of each line, with `offset` taken away.
  Bernstein LeftOf(Point2 p, double offset = 0) const {
    Bernstein f;
    for (std::size_t k = 0; k < Bernstein::kCount; ++k) f.b[k] = x.b[k] * p.y - y.b[k] * p.x - moment.b[k] - offset;
    return f;
  }
  // The lines as a plane mirror through a point shows them; unit normal `n`.
  LineFamily Reflected(Point2 on, Vector2 n) const {
    LineFamily family = *this;
    const double twice = 2 * Dot(n, on - Point2{});
    for (std::size_t k = 0; k < Bernstein::kCount; ++k) {
      const double along = 2 * (x.b[k] * n.x + y.b[k] * n.y);
      family.x.b[k] -= along * n.x, family.y.b[k] -= along * n.y;
      family.moment.b[k] = twice * (family.x.b[k] * n.y - family.y.b[k] * n.x) - moment.b[k];
    }
    return family;
  }
  double At(double t) const { return begin + t * (end - begin); }

  // The family of line(u) over the numbers from begin to end, in as many pieces as it takes to be smooth; calls
  // emit(LineFamily). Where line(u) is absent at a node, pieces are halved as long as
  // hopeful(begin, end) says that they may hold something. Pieces of fit.least_part of the whole, or that are not much
  // longer than kOverlap, are given up, or taken as they are: near a number where lines turn without bound, as at total
  // reflection. Calls give_up(begin, end) for the former.
  template <typename Line, typename Hopeful, typename Emit, typename GiveUp>
  static void Fit(double begin, double end, const Line& line, const Hopeful& hopeful, const Emit& emit,
                  const GiveUp& give_up, const LineFit& fit) {
    const double least = std::max(fit.least_part * (end - begin), 16 * kOverlap);
    FitPart(begin - kOverlap, end + kOverlap, least, fit, line, hopeful, emit, give_up);
  }
  template <typename Line, typename Hopeful, typename Emit>
  static void Fit(double begin, double end, const Line& line, const Hopeful& hopeful, const Emit& emit) {
    Fit(
        begin, end, line, hopeful, emit, [](double, double) {}, LineFit{});
  }

 private:
  template <typename Line, typename Hopeful, typename Emit, typename GiveUp>
  static void FitPart(double begin, double end, double least, const LineFit& fit, const Line& line,
                      const Hopeful& hopeful, const Emit& emit, const GiveUp& give_up) {
    LineFamily family;
    family.begin = begin, family.end = end;
    std::array<double, Bernstein::kCount> x{}, y{}, moment{};
    bool whole = true;
    for (std::size_t i = 0; i < Bernstein::kCount && whole; ++i) {
      const std::optional<DirectedLine> at = line(family.At(Bernstein::Nodes()[i]));
      whole = at.has_value();
      if (whole) x[i] = at->direction.x, y[i] = at->direction.y, moment[i] = at->moment;
    }
    const bool small = end - begin <= least;
    if (whole) {
      family.x = Bernstein::Through(x), family.y = Bernstein::Through(y), family.moment = Bernstein::Through(moment);
      if (small || family.Fits(line, fit)) return emit(family);
    } else if (!hopeful(begin, end)) {
      return;
    } else if (small) {
      return give_up(begin, end);
    }
    const double middle = 0.5 * (begin + end);
    FitPart(begin, middle + kOverlap, least, fit, line, hopeful, emit, give_up);
    FitPart(middle - kOverlap, end, least, fit, line, hopeful, emit, give_up);
  }

  template <typename Line>
  bool Fits(const Line& line, const LineFit& fit) const {
    const auto off = [](const DirectedLine& a, const DirectedLine& b) {
      return std::max({std::abs(a.direction.x - b.direction.x), std::abs(a.direction.y - b.direction.y),
                       std::abs(a.moment - b.moment)});
    };
    for (const double t : {0.0, 0.0301536896, 0.32898992833716567, 0.58682408883346, 0.93301270189221941, 1.0}) {
      const std::optional<DirectedLine> at = line(At(t));
      if (!at) return false;
      const double error = off(*at, {{x.At(t), y.At(t)}, moment.At(t)});
      if (error <= fit.tolerance) continue;
      if (!fit.shift) return false;
      const double shift = std::min(fit.shift(At(t)), 0.5 * (end - begin));
      const std::optional<DirectedLine> beside = line(At(t) + (t < 0.5 ? shift : -shift));
      if (!beside || !(error <= off(*at, *beside))) return false;
    }
    return true;
  }
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_LINE_FAMILY_H_
