// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/moving_ways.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/plane/chains/ray_series.h"

namespace flatlight {
namespace {

// Numbers of ends come from fits; what is farther off is another event.
constexpr double kFarthest = 1e-4;
constexpr int kMostSteps = 12;
constexpr double kSettled = 1e-14;
constexpr double kUnsettled = 1e-7;

}  // namespace

std::optional<ChainRays<3>> MovingWays::Follow(const SpecularWay& way, const Motion& theta, bool moves) const {
  // Plane mirrors show the receiver's motion as they show the receiver.
  const VectorSeries<3> t = VectorSeries<3>::Constant(way.tangent), n = VectorSeries<3>::Constant(way.normal);
  VectorSeries<3> position = VectorSeries<3>::Constant(way.image - Point2{}), tangent = t, normal = n;
  if (moves) {
    const double kappa = receiver_.curvature;
    const Motion s{{0, 1, 0}}, half_square{{0, 0, 0.5}};
    const Motion turn = kappa * s + receiver_.curvature_change * half_square, back = kappa * kappa * half_square;
    position = position + s * t + (kappa * half_square) * n;
    tangent = t - back * t + turn * n;
    normal = n - back * n - turn * t;
  }
  const SinCosSeries<3> of_theta(theta);
  ChainRays<3> rays;
  rays.ray = {position, of_theta.sin * tangent + of_theta.cos * normal};
  rays.flux = Motion::Constant(way.compression);
  const std::size_t plane = way.links.size() - way.turnings.size();
  if (plane > 0) {
    const auto distance = DistanceTo(scene_.element(way.links[plane - 1].element), rays.ray, false, false);
    if (!distance) return std::nullopt;
    rays.ray.from = rays.ray.from + *distance * rays.ray.direction;
  }
  for (std::size_t i = 0; i < way.turnings.size(); ++i) {
    const SpecularWay::Turning& turning = way.turnings[i];
    const auto distance = DistanceTo(*turning.element, rays.ray, turning.far, turning.own_circle);
    if (!distance) return std::nullopt;
    rays.ray.from = rays.ray.from + *distance * rays.ray.direction;
    if (!TurnAt(scene_, way.links[plane + i], rays)) return std::nullopt;
  }
  return rays;
}

std::optional<Motion> MovingWays::MissOf(const MovingEnd& end, const Motion& theta, bool moves) const {
  const std::optional<ChainRays<3>> rays = Follow(*end.way, theta, moves);
  if (!rays) return std::nullopt;
  if (end.border == ElementId::kNone) {
    const VectorSeries<3> point = VectorSeries<3>::Constant(end.mark.point - Point2{});
    return Cross(rays->ray.direction, point - rays->ray.from) - Motion::Constant(end.mark.offset);
  }
  const std::optional<Motion> distance = DistanceBehind(*end.way, *rays, end.border, end.far);
  if (!distance) return std::nullopt;
  const Element& element = scene_.element(end.border);
  const VectorSeries<3> front = FrontOn(element, rays->ray.from + *distance * rays->ray.direction);
  const double ratio = IndexRatio(scene_.curve(element.curve).material, end.side);
  const Motion sine = (1 / ratio) * Cross(front, rays->ray.direction);
  return Motion::Constant(1) - sine * sine;
}

std::optional<Motion> MovingWays::NumberOf(const Directions& directions, const std::shared_ptr<const MovingEnd>& moving,
                                           double found) {
  if (!moving) return Motion::Constant(found);
  if (moving->between) {
    const MovingEnd::Between& between = *moving->between;
    const std::optional<Motion> begin = NumberOf(directions, between.begins, between.begin);
    const std::optional<Motion> end = NumberOf(directions, between.ends, between.end);
    if (!begin || !end) return std::nullopt;
    const double part = (found - between.begin) / (between.end - between.begin);
    return *begin + part * (*end - *begin);
  }
  const auto known = numbers_.find(moving.get());
  if (known != numbers_.end()) return known->second;
  return numbers_[moving.get()] = FindNumber(directions, *moving, found);
}

std::optional<Motion> MovingWays::FindNumber(const Directions& directions, const MovingEnd& moving, double found) {
  Motion number = Motion::Constant(found);
  const Motion beside{{directions.At(found), directions.Slope(found), 0}};
  const std::optional<Motion> still = MissOf(moving, beside, false);
  if (!still || (*still)[1] == 0) return std::nullopt;
  // Newton's method with the slope where it began: each step makes one term more right, and the first one better.
  const double slope = (*still)[1];
  double change = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    const std::optional<Direction> at = At(directions, number);
    const std::optional<Motion> miss = at ? MissOf(moving, at->theta, true) : std::nullopt;
    if (!miss) return std::nullopt;
    change = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double by = (*miss)[k] / slope;
      number[k] -= by;
      change = std::max(change, std::abs(by) / (1 + std::abs(number[k])));
    }
    if (step >= 3 && change < kSettled) break;
  }
  if (!(change < kUnsettled) || !(std::abs(number[0] - found) < kFarthest)) return std::nullopt;
  return number;
}

const std::optional<MovingWays::Range>& MovingWays::RangeOf(const Directions& directions) {
  const auto [at, is_new] = ranges_.try_emplace(&directions);
  if (!is_new) return at->second;
  std::optional<Range> range(Range{Motion::Constant(directions.from), Motion::Constant(directions.to)});
  if (directions.outer) {
    const std::optional<Motion> from = NumberOf(*directions.outer, directions.begins, directions.from);
    const std::optional<Motion> to = NumberOf(*directions.outer, directions.ends, directions.to);
    if (from && to)
      range = Range{*from, *to};
    else
      range.reset();
  }
  return ranges_[&directions] = range;
}

std::optional<MovingWays::Direction> MovingWays::At(const Directions& directions, const Motion& number) {
  const std::optional<Range>& range = RangeOf(directions);
  if (!range) return std::nullopt;
  const Motion width = range->to - range->from;
  const Motion one = Motion::Constant(1);
  const Motion part = directions.eased ? number * number * (Motion::Constant(3) - 2.0 * number) : number;
  const Motion slope = directions.eased ? 6.0 * (number * (one - number)) * width : width;
  const Motion outward = range->from + width * part;
  if (!directions.outer) return Direction{outward, slope};
  std::optional<Direction> outer = At(*directions.outer, outward);
  if (outer) outer->slope = outer->slope * slope;
  return outer;
}

}  // namespace flatlight
