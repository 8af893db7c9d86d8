// SPDX-License-Identifier: Apache-2.0
// What the rays of a beam meet, and what is not known of it where elements follow Béziers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/plane/chains/beam_cuts.h"
#include "core/plane/reference/bezier_span.h"
#include "core/plane/reference/specular_view.h"

namespace flatlight {
namespace {

// A ray that comes back to the Bézier from which it starts is farther away.
constexpr double kOwnPlace = 1e-9;

}  // namespace

// Adds where the rays of a beam begin or cease to meet things.
void SpecularView::FindCuts(const Receiver& receiver, const Beam& beam, Cuts& cuts) const {
  const ElementId last = LastOf(receiver, *beam.way);
  const std::vector<Element>& elements = scene_.elements();
  std::vector<double> events;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Element& element = elements[i];
    const auto id = static_cast<ElementId>(i);
    if (const BezierSpan* const span = spans_->Of(id); span != nullptr && i == span->first()) {
      const bool turns = TurnsAt(scene_, id), passed = span->IsPassedBy(beam.lines, 4 * scene_.bezier_distance());
      if (turns && !passed) span->AddEvents(beam.lines, events);
      if (turns || passed) {
        i = span->end() - 1;
        continue;
      }
    }
    const bool own = last != ElementId::kNone && element.carrier == scene_.element(last).carrier;
    if (own && element.kind == Element::Kind::kSegment) continue;
    if (own || !PassBy(beam.lines, element)) cuts.AddEndsOf(element, beam.lines);
  }
  for (const double t : events) cuts.Add(beam.lines.At(t));
  for (const Point2 crossing : crossings_) cuts.AddPassing(beam.lines, {crossing});
}

// Whether all its lines are as near to one another as elements are to the Béziers that they follow.
bool SpecularView::IsNarrow(const Beam& beam, double from, double to) const {
  const LineFamily& lines = beam.lines;
  const double t = (from - lines.begin) / (lines.end - lines.begin), u = (to - lines.begin) / (lines.end - lines.begin);
  const double off = std::abs(lines.x.At(t) - lines.x.At(u)) + std::abs(lines.y.At(t) - lines.y.At(u)) +
                     std::abs(lines.moment.At(t) - lines.moment.At(u));
  return off < 8 * scene_.bezier_distance();
}

double SpecularView::DoubtAt(const Receiver& receiver, const Beam& beam, const Met& before, const Met& after,
                             double x) const {
  // Mirrors and glass are met where they are, not where their elements are; but these tell where they cross others.
  const auto follows = [&](const Met& met) {
    return met.element != ElementId::kNone && scene_.bezier_piece(scene_.element(met.element)) != nullptr &&
           (!crossings_.empty() || !TurnsAt(scene_, met.element));
  };
  if (!follows(before) && !follows(after)) return 0;
  // What is seen straight away is known otherwise.
  const auto counts = [&](const Met& met) {
    if (met.element == ElementId::kNone) return scene_.traits().environment && !beam.way->links.empty();
    if (TurnsAt(scene_, met.element)) return true;
    const Curve& curve = scene_.curve_of(met.element);
    return !beam.way->links.empty() && (!curve.reflectance.IsBlack() || !curve.EmittedRadiance(met.side).IsBlack());
  };
  if (!counts(before) && !counts(after)) return 0;
  if (before.element != ElementId::kNone && after.element != ElementId::kNone && before.side == after.side) {
    // Where one element of a Bézier ends and the next begins nothing changes.
    const Element &e = scene_.element(before.element), &f = scene_.element(after.element);
    const auto first = std::min(before.element, after.element), second = std::max(before.element, after.element);
    if (e.curve == f.curve && static_cast<std::size_t>(second) == static_cast<std::size_t>(first) + 1) return 0;
  }
  // The nearer of both is what begins or ends there.
  const double beside = 1e-6 * (beam.end - beam.begin);
  std::optional<Point2> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [met, at] : {std::pair{before, x - beside}, std::pair{after, x + beside}}) {
    if (met.element == ElementId::kNone || met.doubtful) continue;
    const std::optional<SpecularRay> ray = FollowWay(scene_, *beam.way, beam.directions->At(at));
    if (!ray) continue;
    const double distance = DistanceTo(receiver, beam, met, *ray).value_or(met.distance);
    if (!(distance < least)) continue;
    least = distance;
    nearest = ray->from + distance * ray->direction;
  }
  if (!nearest) return 0;
  const Bernstein offset = beam.lines.LeftOf(*nearest);
  const double span = beam.lines.end - beam.lines.begin, t = (x - beam.lines.begin) / span;
  const double doubt = 4 * scene_.bezier_distance() + std::abs(offset.At(t));
  double low = t, high = t;
  for (double step = 1e-12; step < 1; step *= 2) {
    if (std::abs(offset.At(low)) <= doubt) low = std::max(t - step, 0.0);
    if (std::abs(offset.At(high)) <= doubt) high = std::min(t + step, 1.0);
  }
  return MostOf(beam, std::max(beam.begin, beam.lines.At(low)), std::min(beam.end, beam.lines.At(high)));
}

std::optional<SpecularView::Met> SpecularView::MetBy(const Receiver& receiver, const Beam& beam, double x) const {
  const std::optional<SpecularRay> ray = FollowWay(scene_, *beam.way, beam.directions->At(x));
  if (!ray) return std::nullopt;
  SurfacePoint from{ray->from, LastOf(receiver, *beam.way)};
  const BezierSpan* own = nullptr;
  if (beam.way->links.empty()) {
    from.position = receiver.position;
    if (receiver.element != ElementId::kNone) own = spans_->Of(receiver.element);
  } else if (!beam.way->turnings.empty()) {
    own = beam.way->turnings.back().span;
    if (own != nullptr) from = own->OnElement(scene_, ray->place);
  }
  const std::optional<Hit> hit = caster_.ClosestHit(from, ray->direction);
  if (!hit) return Met{};
  const Element& element = scene_.element(hit->element);
  const Side side = Dot(hit->normal, ray->direction) < 0 ? Side::kFront : Side::kBack;
  if (element.bezier_piece != Element::kNoBezier && TurnsAt(scene_, hit->element)) {
    if (const BezierSpan* const span = spans_->Of(hit->element)) {
      Met met{static_cast<ElementId>(span->first()), side};
      const std::optional<double> distance = DistanceTo(receiver, beam, met, *ray);
      met.doubtful = !(distance && *distance > (span == own ? kOwnPlace : 0));
      met.distance = distance.value_or(0);
      return met;
    }
    // Where it is as good as a point its directions are not known.
    if (!scene_.beziers()[scene_.bezier_piece(element)->bezier].IsStraight()) return Met{.doubtful = true};
  }
  const bool far =
      element.kind == Element::Kind::kArc && hit->distance > Dot(element.center - ray->from, ray->direction);
  return Met{hit->element, side, far, false, hit->distance};
}

std::optional<double> SpecularView::DistanceTo(const Receiver& receiver, const Beam& beam, const Met& met,
                                               const SpecularRay& ray) const {
  const BezierSpan* const span = spans_->Of(met.element);
  if (span == nullptr || !TurnsAt(scene_, met.element))
    return DistanceBehind(scene_, receiver, *beam.way, ray, met.element, met.far);
  const std::optional<double> place = span->Meet(ray.from, ray.direction, met.side == Side::kFront);
  if (!place) return std::nullopt;
  return Dot(span->At(*place) - ray.from, ray.direction);
}

}  // namespace flatlight
