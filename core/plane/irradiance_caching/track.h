// SPDX-License-Identifier: Apache-2.0
// Lines along which irradiance is wanted.
#ifndef FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_TRACK_H_
#define FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_TRACK_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/cache/gap.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// One side of a straight or smoothly bent run of a curve's pieces, by the curve's arc length; or a straight row of free
// points that look the same way.
class Track {
 public:
  // Elements [first, last), each of which goes on where the one before ended, in its direction.
  Track(const Scene& scene, std::size_t first, std::size_t last, Side side);
  // Along the tangent of a free point, from there.
  Track(const Scene& scene, const Receiver& origin);

  Receiver At(double coordinate) const;
  // Absent (kNone) for free points.
  CurveId curve() const { return curve_; }
  Side side() const { return side_; }
  // Whether coordinates are arc lengths of a curve; else they are distances from the free point.
  bool by_arc_length() const { return first_ != last_; }
  // Of free points: where a place lies along the tangent.
  double CoordinateOf(Point2 place) const { return Dot(origin_.tangent, place - origin_.position); }

 private:
  const Scene* scene_;
  std::size_t first_ = 0, last_ = 0;
  Receiver origin_;
  CurveId curve_ = CurveId::kNone;
  Side side_ = Side::kFront;
};

struct TrackPlace {
  std::uint32_t track = 0;
  double at = 0;
};

struct Tracks {
  std::vector<Track> tracks;
  std::vector<std::vector<double>> points;  // By track, in order along it.
  std::vector<TrackCorners> corners;        // By track.
  std::vector<TrackPlace> of_point;         // By probe point.
};

// Curves with corners have a track for each smooth run, which ends where another curve stands on it or crosses it; rows
// of free points end where a curve comes between two of them. `caster`'s scene has the world of `scene`.
Tracks TracksOf(const Scene& scene, const RayCaster& caster);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_TRACK_H_
