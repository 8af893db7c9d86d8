// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/visible_light.h"

#include <algorithm>
#include <cmath>

namespace flatlight {
namespace {

// Far above the rounding of the polygon's corners, far below the segments.
constexpr double kNear = 1e-9;

double DistanceTo(const SegmentDescription& segment, Point2 p) {
  const Vector2 along = segment.b - segment.a;
  const double u = std::clamp(Dot(p - segment.a, along) / LengthSquared(along), 0.0, 1.0);
  return Length(p - (segment.a + u * along));
}

}  // namespace

VisibleLight::VisibleLight(const std::vector<SegmentDescription>& segments, const std::vector<double>& radiance)
    : segments_(segments),
      radiance_(radiance),
      grid_(static_cast<int>(std::sqrt(static_cast<double>(segments.size())))) {
  for (std::uint32_t i = 0; i < segments.size(); ++i) grid_.Add(i, segments[i]);
}

std::optional<double> VisibleLight::Irradiance(Point2 point, Vector2 normal, const std::vector<Point2>& polygon) {
  const Vector2 tangent = Right(normal);
  double irradiance = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
    Vector2 p = from - point, q = to - point;
    if (std::abs(Cross(p, q)) <= kNear * Length(p) * Length(q)) continue;
    const std::optional<std::uint32_t> segment = SegmentAt(from + 0.5 * (to - from));
    if (!segment) return std::nullopt;
    const SegmentDescription& seen = segments_[*segment];
    if (Cross(seen.b - seen.a, point - seen.a) < 0) continue;  // Its back.
    const double above_p = Dot(normal, p), above_q = Dot(normal, q);
    if (above_p <= 0 && above_q <= 0) continue;
    const Vector2 cut = p + above_p / (above_p - above_q) * (q - p);  // At the horizon; used if it is crossed.
    if (above_p < 0) p = cut;
    if (above_q < 0) q = cut;
    // The integral of the cosine over the directions, which turn from the tangent to the normal.
    irradiance += radiance_[*segment] * (Dot(tangent, p) / Length(p) - Dot(tangent, q) / Length(q));
  }
  return irradiance;
}

std::optional<std::uint32_t> VisibleLight::SegmentAt(Point2 place) {
  std::optional<std::uint32_t> nearest;
  double distance = kNear;
  const Vector2 margin{kNear, kNear};
  grid_.ForEachNear(place - margin, place + margin, [&](std::uint32_t index) {
    const double d = DistanceTo(segments_[index], place);
    if (d < distance) distance = d, nearest = index;
    return true;
  });
  return nearest;
}

}  // namespace flatlight
