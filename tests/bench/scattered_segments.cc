// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/scattered_segments.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/math/vec.h"
#include "tests/bench/random_scenes.h"
#include "tests/bench/segment_grid.h"

namespace flatlight {
namespace {

SegmentDescription Scatter(double length, RandomNumbers& random) {
  const double x = random.Next(), y = random.Next();
  const double angle = 2 * std::numbers::pi * random.Next();
  const Vector2 half{0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle)};
  return {Point2{x, y} - half, Point2{x, y} + half};
}

// Far above the rounding of the products below, so that programs with other arithmetic see the segments apart too.
constexpr double kMargin = 1e-12;

// Whether the line of `line` has both ends of `other` on one side of it.
bool OnOneSide(const SegmentDescription& line, const SegmentDescription& other) {
  const Vector2 along = line.b - line.a;
  const double a = Cross(along, other.a - line.a), b = Cross(along, other.b - line.a);
  return std::min(a, b) > kMargin || std::max(a, b) < -kMargin;
}

bool Apart(const SegmentDescription& s, const SegmentDescription& t) { return OnOneSide(s, t) || OnOneSide(t, s); }

bool Inside(Point2 p) { return std::min({p.x, p.y, 1 - p.x, 1 - p.y}) > kMargin; }

}  // namespace

double LengthRule::For(int count) const { return shrinks ? factor / std::sqrt(count) : factor; }

std::string LengthRule::Name() const {
  char text[32];
  std::snprintf(text, sizeof(text), shrinks ? "%g/sqrt(n)" : "%g", factor);
  return text;
}

std::vector<SegmentDescription> ScatteredSegments(int count, double length, std::uint64_t seed) {
  RandomNumbers random(seed);
  std::vector<SegmentDescription> segments;
  segments.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) segments.push_back(Scatter(length, random));
  return segments;
}

std::optional<std::vector<SegmentDescription>> ScatteredApart(int count, double length, std::uint64_t seed) {
  constexpr int kMaxTries = 1'000'000;
  RandomNumbers random(seed);
  std::vector<SegmentDescription> segments;
  SegmentGrid grid(static_cast<int>(std::min(1 / length, std::sqrt(count))));
  for (int tries = 0; static_cast<int>(segments.size()) < count;) {
    if (tries++ == kMaxTries) return std::nullopt;
    const SegmentDescription segment = Scatter(length, random);
    if (!Inside(segment.a) || !Inside(segment.b)) continue;
    bool fits = true;
    grid.ForEachNear(segment.a, segment.b, [&](std::uint32_t other) { return fits = Apart(segment, segments[other]); });
    if (!fits) continue;
    grid.Add(static_cast<std::uint32_t>(segments.size()), segment);
    segments.push_back(segment);
    tries = 0;
  }
  return segments;
}

}  // namespace flatlight
