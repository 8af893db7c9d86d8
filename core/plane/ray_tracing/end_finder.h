// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_RAY_TRACING_END_FINDER_H_
#define FLATLIGHT_CORE_PLANE_RAY_TRACING_END_FINDER_H_

#include <optional>

#include "core/plane/exact/edge.h"
#include "core/plane/ray_tracing/hemicircle_gather.h"
#include "core/scene/scene.h"

namespace flatlight {

// Looks from a receiver for the end of the piece that a ray meets, on the way to a neighbouring ray.
class EndFinder {
 public:
  // Both must outlive this.
  EndFinder(const Scene& scene, const Receiver& receiver) : scene_(scene), receiver_(receiver) {}

  // Where the nearer of two neighbours' surfaces ends between them; absent if it does not.
  std::optional<Edge> Between(const GatheredRay& a, const GatheredRay& b) const;

 private:
  std::optional<Edge> Silhouette(ElementId piece, const GatheredRay& near, const GatheredRay& far) const;
  // On the Bézier that a piece follows.
  std::optional<Edge> OnBezier(const BezierPiece& on, const Element& piece, const GatheredRay& near,
                               const GatheredRay& far) const;
  // Whether some piece of the curve on the circle of `piece` has the point.
  bool OnArc(const Curve& curve, const Element& piece, Point2 point) const;

  const Scene& scene_;
  const Receiver& receiver_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_RAY_TRACING_END_FINDER_H_
