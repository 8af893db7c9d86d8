// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/family_parts.h"

#include <algorithm>

namespace flatlight::stress {

Look Pieces::AnyLook() {
  if (random_.Chance(0.5)) return Dark();
  return {.radiance = {random_.Uniform(0.5, 2)}, .two_sided = random_.Chance(0.4)};
}

void Pieces::Segment(Point2 a, Point2 b, const Look& look) {
  if (!(a == b)) maker_.Segment(NextName(), a, b, look);
}

void Pieces::Polyline(std::vector<Point2> points, bool closed, const Look& look) {
  points.erase(std::unique(points.begin(), points.end()), points.end());
  while (closed && points.size() > 1 && points.front() == points.back()) points.pop_back();
  if (points.size() > 1) maker_.Polyline(NextName(), std::move(points), closed, look);
}

void Pieces::Arc(Point2 center, double radius, double start, double sweep, const Look& look) {
  maker_.Arc(NextName(), {center, radius, start, std::clamp(sweep, -2 * kPi, 2 * kPi)}, look);
}

void Pieces::ProbeCurve(std::size_t curve, std::uint32_t count, Side side) {
  maker_.Probe("c" + std::to_string(curve), count, side);
}

void Pieces::ProbeCurves(int most) {
  for (int i = 0; i < most && count_ > 0; ++i) {
    const auto curve = static_cast<std::size_t>(random_.Below(count_));
    ProbeCurve(curve, static_cast<std::uint32_t>(random_.Int(1, 3)), random_.Chance(0.5) ? Side::kFront : Side::kBack);
  }
}

void Pieces::FreePoints(int count) {
  for (int i = 0; i < count; ++i) {
    const Point2 position = random_.Point();
    FreePoint(position, random_.Direction());
  }
}

SceneDescription Pieces::Take() {
  if (maker_.description().probes.empty()) FreePoints(1);
  return maker_.description();
}

}  // namespace flatlight::stress
