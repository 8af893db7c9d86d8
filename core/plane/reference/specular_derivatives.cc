// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/specular_derivatives.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/plane/reference/quadrature.h"

namespace flatlight {
namespace {

constexpr std::size_t kPoints = 10;
constexpr int kMostHalvings = 30;
// A derivative may be off by so much more than the one before; lengths of a scene are of the order of 1.
constexpr double kByOrder = 10;
// Beside the sum of what is positive and negative alike: rounding.
constexpr double kRounding = 1e-13;

// As Chart::Find.
Motion Find(const Element& element, const Chart& chart, const VectorSeries<3>& place) {
  const VectorSeries<3> from_a = place - VectorSeries<3>::Constant(element.a - Point2{});
  if (element.kind == Element::Kind::kSegment) {
    const Vector2 along = element.b - element.a;
    return (1 / LengthSquared(along)) * Dot(from_a, VectorSeries<3>::Constant(along));
  }
  const VectorSeries<3> radial = VectorSeries<3>::Constant(element.radial_a);
  const VectorSeries<3> v = radial + (1 / element.radius) * from_a;
  return Cross(radial, v) / (chart.half_tangent() * (Sqrt(Dot(v, v)) + Dot(radial, v)));
}

}  // namespace

SpecularDerivatives::Moments SpecularDerivatives::OfPiece(const SpecularPiece& piece) {
  const Directions& directions = *piece.directions;
  const std::optional<Motion> from = ways_.NumberOf(directions, piece.begins, piece.begin);
  const std::optional<Motion> to = ways_.NumberOf(directions, piece.ends, piece.end);
  if (!from || !to) return Moments{.known = false};
  return piece.way->straight ? OfSines(directions, *from, *to) : Of(piece, nullptr, 1, *from, *to);
}

SpecularDerivatives::Moments SpecularDerivatives::OfUnfollowed(const UnfollowedBeam& beam) {
  const std::optional<Motion> from = ways_.NumberOf(*beam.directions, beam.begins, beam.begin);
  const std::optional<Motion> to = ways_.NumberOf(*beam.directions, beam.ends, beam.end);
  Moments all;
  if (from && to)
    all = OfSines(*beam.directions, *from, *to);
  else
    all.known = false;
  for (double& part : all.of_value) part *= beam.share;
  return all;
}

SpecularDerivatives::Moments SpecularDerivatives::OfSines(const Directions& directions, const Motion& from,
                                                          const Motion& to) {
  Moments all;
  const std::optional<MovingWays::Direction> begin = ways_.At(directions, from), end = ways_.At(directions, to);
  if (!begin || !end) return Moments{.known = false};
  const Motion sines = SinCosSeries<3>(end->theta).sin - SinCosSeries<3>(begin->theta).sin;
  for (std::size_t m = 0; m < orders_; ++m) {
    all.value[m][0] = sines.Derivative(m);
    all.of_value[m] = std::abs(all.value[m][0]);
  }
  return all;
}

SpecularDerivatives::Moments SpecularDerivatives::OfPanel(const SpecularPiece& piece, const Panel& panel,
                                                          std::size_t count, const Cuts::Cut& begin,
                                                          const Cuts::Cut& end) {
  const auto number_of = [&](const Cuts::Cut& cut) {
    if (cut.mark) return ways_.FindNumber(*piece.directions, {.way = piece.way, .mark = *cut.mark}, cut.at);
    return ways_.NumberOf(*piece.directions, cut.at == piece.begin ? piece.begins : piece.ends, cut.at);
  };
  const std::optional<Motion> from = number_of(begin), to = number_of(end);
  if (!from || !to) return Moments{.known = false};
  return Of(piece, &panel, count, *from, *to);
}

bool SpecularDerivatives::AddPoint(const SpecularPiece& piece, const Panel* panel, std::size_t count,
                                   const Directions& part, const Motion& from, const Motion& to, double x,
                                   double weight, Moments& sum) {
  const double within = part.Outward(x), slope = part.Slope(x);
  const std::optional<MovingWays::Direction> direction = ways_.At(*piece.directions, from + within * (to - from));
  if (!direction) return false;
  const std::optional<ChainRays<3>> rays = ways_.Follow(*piece.way, direction->theta);
  if (!rays) return false;
  const Motion share =
      (weight * slope) * ((to - from) * direction->slope) * (SinCosSeries<3>(direction->theta).cos * rays->flux);
  const double by_value[3] = {share[0], share[1], 2 * share[2]};
  if (panel == nullptr) {
    for (std::size_t m = 0; m < orders_; ++m) {
      sum.value[m][0] += by_value[m];
      sum.of_value[m] += std::abs(by_value[m]);
    }
    return true;
  }
  const std::optional<Motion> distance = ways_.DistanceBehind(*piece.way, *rays, piece.element, piece.far);
  if (!distance) return false;
  const Motion u = Find(scene_.element(piece.element), charts_[static_cast<std::size_t>(piece.element)],
                        rays->ray.from + *distance * rays->ray.direction);
  // By the panel's place in [-1, 1].
  const double scale = 2 / (panel->high - panel->low), first = scale * u[1], second = 2 * scale * u[2];
  double p[kResidualCoefficients], slopes[kResidualCoefficients], bends[kResidualCoefficients];
  LegendreWithBends(std::clamp(panel->Local(u[0]), -1.0, 1.0), count, p, slopes, bends);
  const double by_slope[3] = {0, share[0] * first, 2 * share[1] * first + share[0] * second};
  const double by_bend = share[0] * first * first;
  for (std::size_t m = 0; m < orders_; ++m) {
    for (std::size_t i = 0; i < count; ++i)
      sum.value[m][i] += by_value[m] * p[i] + by_slope[m] * slopes[i] + (m == 2 ? by_bend * bends[i] : 0);
    sum.of_value[m] += std::abs(by_value[m]);
    sum.of_slope[m] += std::abs(by_slope[m]);
  }
  sum.of_bend[2] += std::abs(by_bend);
  return true;
}

SpecularDerivatives::Moments SpecularDerivatives::Of(const SpecularPiece& piece, const Panel* panel, std::size_t count,
                                                     const Motion& from, const Motion& to) {
  // As SpecularGather has it.
  const bool eased = panel != nullptr && scene_.element(piece.element).kind == Element::Kind::kArc;
  const Directions part{0, 1, eased, nullptr};
  const GaussRule& rule = Gauss(kPoints);
  const auto sum_over = [&](double low, double high) {
    Moments sum;
    for (std::size_t k = 0; k < kPoints; ++k) {
      const double x = 0.5 * ((1 - rule.node[k]) * low + (1 + rule.node[k]) * high);
      sum.known &= AddPoint(piece, panel, count, part, from, to, x, 0.5 * (high - low) * rule.weight[k], sum);
    }
    return sum;
  };
  Moments all;
  const double angle = piece.directions->At(to[0]) - piece.directions->At(from[0]);
  const double tolerance = tolerance_ * angle / std::numbers::pi;
  // Depth first, so that the order of sums is fixed.
  const auto refine = [&](const auto& self, double low, double high, const Moments& whole, int depth) -> void {
    const double middle = 0.5 * (low + high);
    const Moments parts[2] = {sum_over(low, middle), sum_over(middle, high)};
    double off[3] = {0, 0, 0}, allowed = tolerance;
    bool done = true;
    for (std::size_t m = 0; m < orders_; ++m) {
      for (std::size_t i = 0; i < count; ++i)
        off[m] = std::max(off[m], std::abs(parts[0].value[m][i] + parts[1].value[m][i] - whole.value[m][i]));
      done &= off[m] <= std::max(allowed, kRounding * (whole.of_value[m] + whole.of_slope[m] + whole.of_bend[m]));
      allowed *= kByOrder;
    }
    if (!done && depth < kMostHalvings) {
      self(self, low, middle, parts[0], depth + 1);
      self(self, middle, high, parts[1], depth + 1);
      return;
    }
    for (std::size_t m = 0; m < orders_; ++m) {
      for (const Moments& half : parts) {
        for (std::size_t i = 0; i < count; ++i) all.value[m][i] += half.value[m][i];
        all.of_value[m] += half.of_value[m];
        all.of_slope[m] += half.of_slope[m];
        all.of_bend[m] += half.of_bend[m];
        all.known &= half.known;
      }
      all.error[m] += off[m];
    }
  };
  refine(refine, 0, 1, sum_over(0, 1), 0);
  return all;
}

}  // namespace flatlight
