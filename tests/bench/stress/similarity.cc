// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/similarity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_set>

#include "core/math/tolerances.h"
#include "core/math/trig.h"
#include "tests/bench/stress/random.h"

namespace flatlight::stress {
namespace {

// The other way: what was at a fraction f of the length is at 1 - f.
void Reverse(CurveDescription& curve) {
  if (auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
    std::swap(segment->a, segment->b);
  } else if (auto* polyline = std::get_if<PolylineDescription>(&curve.shape)) {
    // A closed one goes on beginning at its first point.
    std::reverse(polyline->points.begin() + (polyline->closed ? 1 : 0), polyline->points.end());
  } else if (auto* bezier = std::get_if<BezierDescription>(&curve.shape)) {
    std::swap(bezier->p0, bezier->p3), std::swap(bezier->p1, bezier->p2);
  } else {
    auto& arc = std::get<ArcDescription>(curve.shape);
    arc.start_angle += arc.sweep_angle;
    arc.sweep_angle = -arc.sweep_angle;
  }
}

void ReverseProbe(ProbeDescription& probe) {
  const double from = probe.from.value_or(0), to = probe.to.value_or(1);
  probe.from = 1 - from;
  probe.to = 1 - to;
}

template <typename Look>
void LookAtPoints(const SceneDescription& scene, Look look) {
  for (const CurveDescription& curve : scene.curves) {
    if (const auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
      look(segment->a), look(segment->b);
    } else if (const auto* polyline = std::get_if<PolylineDescription>(&curve.shape)) {
      for (const Point2 point : polyline->points) look(point);
    } else if (const auto* bezier = std::get_if<BezierDescription>(&curve.shape)) {
      look(bezier->p0), look(bezier->p1), look(bezier->p2), look(bezier->p3);
    } else {
      look(std::get<ArcDescription>(curve.shape).center);
    }
  }
  for (const ProbeDescription& probe : scene.probes)
    for (const ProbePointDescription& point : probe.points) look(point.position);
}

}  // namespace

Vector2 Similarity::Turned(Vector2 v) const {
  if (mirrored) v.x = -v.x;
  if (angle != 0) {
    const SinCosValue turn = SinCos(angle);
    v = {turn.cos * v.x - turn.sin * v.y, turn.sin * v.x + turn.cos * v.y};
  }
  for (int i = 0; i < (quarters & 3); ++i) v = Left(v);
  return v;
}

Point2 Similarity::operator()(Point2 p) const { return Point2{} + scale * Turned(p - Point2{}) + shift; }

SceneDescription Moved(const SceneDescription& scene, const Similarity& similarity) {
  SceneDescription moved = scene;
  for (CurveDescription& curve : moved.curves) {
    if (auto* segment = std::get_if<SegmentDescription>(&curve.shape)) {
      segment->a = similarity(segment->a), segment->b = similarity(segment->b);
    } else if (auto* polyline = std::get_if<PolylineDescription>(&curve.shape)) {
      for (Point2& point : polyline->points) point = similarity(point);
    } else if (auto* bezier = std::get_if<BezierDescription>(&curve.shape)) {
      for (Point2* point : {&bezier->p0, &bezier->p1, &bezier->p2, &bezier->p3}) *point = similarity(*point);
    } else {
      auto& arc = std::get<ArcDescription>(curve.shape);
      arc.center = similarity(arc.center);
      arc.radius *= similarity.scale;
      if (similarity.mirrored) {
        arc.start_angle = std::numbers::pi - arc.start_angle;
        arc.sweep_angle = -arc.sweep_angle;
      }
      arc.start_angle += similarity.angle + similarity.quarters * (std::numbers::pi / 2);
    }
    if (similarity.mirrored) Reverse(curve);
  }
  for (ProbeDescription& probe : moved.probes) {
    if (probe.curve && similarity.mirrored) ReverseProbe(probe);
    for (ProbePointDescription& point : probe.points) {
      point.position = similarity(point.position);
      point.normal = similarity.Turned(point.normal);
    }
  }
  return moved;
}

bool IsExact(const SceneDescription& scene, const Similarity& similarity) {
  bool exact = true;
  LookAtPoints(scene, [&](Point2 p) {
    const Vector2 turned = similarity.scale * similarity.Turned(p - Point2{});
    exact = exact && similarity(p) - similarity.shift == Point2{} + turned;
  });
  return exact;
}

double RoundingOf(const SceneDescription& moved, const Similarity& similarity) {
  double largest = 0;
  LookAtPoints(moved, [&](Point2 p) { largest = std::max({largest, std::abs(p.x), std::abs(p.y)}); });
  for (const CurveDescription& curve : moved.curves)
    if (const auto* arc = std::get_if<ArcDescription>(&curve.shape)) largest = std::max(largest, arc->radius);
  // Each coordinate: two products, a sum, the scale, the shift; those before the shift are of the size of what the
  // shift leaves, or of the shift itself.
  const double before = largest + std::max(std::abs(similarity.shift.x), std::abs(similarity.shift.y));
  return 6 * kUnitRoundoff * before + RoundingOfArcs(moved);
}

double RoundingOfArcs(const SceneDescription& scene) {
  double largest = 0;
  for (const CurveDescription& curve : scene.curves) {
    if (const auto* arc = std::get_if<ArcDescription>(&curve.shape)) {
      // Angles are sums of a start, a sweep and a turn, and their sines are correct to 2 units in the last place.
      largest = std::max(largest, arc->radius * (3 * std::abs(arc->start_angle) + 3 * std::abs(arc->sweep_angle) + 16));
    }
  }
  return kUnitRoundoff * largest;
}

SceneDescription Shuffled(const SceneDescription& scene, std::uint64_t seed) {
  SceneDescription shuffled = scene;
  Random random(seed);
  for (std::size_t i = shuffled.curves.size(); i > 1; --i) {
    std::swap(shuffled.curves[i - 1], shuffled.curves[random.Below(i)]);
  }
  return shuffled;
}

SceneDescription Reversed(const SceneDescription& scene, std::vector<bool>& turned) {
  SceneDescription reversed = scene;
  std::unordered_set<std::string> names;
  for (CurveDescription& curve : reversed.curves) {
    if (curve.emission && !curve.emission->two_sided) continue;
    Reverse(curve);
    names.insert(curve.name);
  }
  turned.assign(reversed.probes.size(), false);
  for (std::size_t p = 0; p < reversed.probes.size(); ++p) {
    ProbeDescription& probe = reversed.probes[p];
    if (!probe.curve || !names.contains(*probe.curve)) continue;
    ReverseProbe(probe);
    probe.side = probe.side.value_or(Side::kFront) == Side::kFront ? Side::kBack : Side::kFront;
    turned[p] = true;
  }
  return reversed;
}

}  // namespace flatlight::stress
