// SPDX-License-Identifier: Apache-2.0
// What a receiver sees over mirrors and through glass, as it moves: power series in the arc length by which it does.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_MOVING_WAYS_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_MOVING_WAYS_H_

#include <memory>
#include <optional>
#include <unordered_map>

#include "core/math/check.h"
#include "core/math/series.h"
#include "core/plane/chains/chain.h"
#include "core/plane/reference/specular_view.h"
#include "core/scene/scene.h"

namespace flatlight {

// Value, first derivative, half the second.
using Motion = Series<3>;

// Of one receiver, which must outlive it, as the scene must. Requires a scene without Béziers.
class MovingWays {
 public:
  MovingWays(const Scene& scene, const Receiver& receiver) : scene_(scene), receiver_(receiver) {
    FLATLIGHT_DCHECK(!scene.traits().has_beziers);
  }

  // As FollowWay: `flux` is the share. The directions move as `theta` does.
  std::optional<ChainRays<3>> Follow(const SpecularWay& way, const Motion& theta) const {
    return Follow(way, theta, true);
  }
  // How far they go on to the line or circle of what they meet, as DistanceBehind.
  std::optional<Motion> DistanceBehind(const SpecularWay& way, const ChainRays<3>& rays, ElementId element,
                                       bool far) const {
    return DistanceTo(scene_.element(element), rays.ray, far, ComesFromCircle(scene_, receiver_, way, element));
  }

  // The number that an end of a stretch of directions moves to, near where it was found; `moving` may be null. Absent
  // where it cannot be told: two events coincide.
  std::optional<Motion> NumberOf(const Directions& directions, const std::shared_ptr<const MovingEnd>& moving,
                                 double found);
  // The same of one that is not known any longer than this.
  std::optional<Motion> FindNumber(const Directions& directions, const MovingEnd& moving, double found);

  // Theta, and its derivative by the number, of a number that moves. Absent where ends of the directions are.
  struct Direction {
    Motion theta, slope;
  };
  std::optional<Direction> At(const Directions& directions, const Motion& number);

 private:
  // The range of directions, as numbers of their outer ones.
  struct Range {
    Motion from, to;
  };

  std::optional<ChainRays<3>> Follow(const SpecularWay& way, const Motion& theta, bool moves) const;
  // How far a ray of theta is beside the end, in some measure: 0 there. If not `moves`, the receiver stands still.
  std::optional<Motion> MissOf(const MovingEnd& end, const Motion& theta, bool moves) const;
  const std::optional<Range>& RangeOf(const Directions& directions);

  const Scene& scene_;
  const Receiver& receiver_;
  std::unordered_map<const Directions*, std::optional<Range>> ranges_;
  std::unordered_map<const MovingEnd*, std::optional<Motion>> numbers_;  // Of those that are not in between.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_MOVING_WAYS_H_
