// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_RAY_TRACING_HEMICIRCLE_GATHER_H_
#define FLATLIGHT_CORE_PLANE_RAY_TRACING_HEMICIRCLE_GATHER_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/plane/exact/edge.h"
#include "core/plane/ray_tracing/ray_tree.h"
#include "core/scene/scene.h"

namespace flatlight {

// A ray that stands for a stretch of the hemicircle. Angles are told by their sine, from the receiver's normal toward
// its tangent.
struct GatheredRay {
  double begin = -1;  // The stretch, in sines.
  double end = 1;
  double sine = 0;
  double cosine = 1;
  Spectrum radiance;
  // Where it comes from; infinitely far away if `element` is kNone.
  ElementId element = ElementId::kNone;
  Vector2 to;      // From the receiver.
  Vector2 normal;  // Unit, of the curve there, toward the receiver.
  // Between the ray before and this one, if it is known where: the end of the nearer of two surfaces.
  std::optional<Edge> break_before;

  double InverseDistance() const { return element == ElementId::kNone ? 0 : 1 / Length(to); }
};

// Casts about `rays` rays from a receiver, one at random in each of `rays` stretches of equal sine, to `gathered` in
// order of their angle. The stretches begin at a random place, so there is one more, and where an edge falls among them
// is random too. Adds the rays cast.
void GatherHemicircle(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                      const Cancellation& cancellation, std::vector<GatheredRay>& gathered, double& cast);

// For derivatives: where neighbouring rays meet different surfaces and the nearer one ends between them, looks past its
// end for what lies behind, with a ray that stands for no stretch; and goes on so beyond what that finds. Light that
// shows in a gap narrower than a stretch is found. So are straight pieces that are seen edge-on. (Li et al. 2018,
// "Differentiable Monte Carlo ray tracing through edge sampling".)
void LookPastEnds(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                  const Cancellation& cancellation, std::vector<GatheredRay>& gathered, double& cast);

// What comes straight from an emitter, or from the sky, along the ray.
Spectrum EmittedToward(const Scene& scene, const Receiver& receiver, const GatheredRay& ray);

// Irradiance: radiance times stretch.
Spectrum IrradianceOf(const std::vector<GatheredRay>& gathered);

// The derivative of irradiance per radian that the normal turns toward the tangent: the integral of radiance over the
// cosine of its direction (THEORY 6.5). Unbiased, blockers or not, for rays as GatherHemicircle leaves them. Few sines
// at the horizon are many cosines: there it casts two more rays.
Spectrum RotationOf(const RayTree& tree, const Receiver& receiver, std::uint32_t rays, std::uint64_t key,
                    const Cancellation& cancellation, const std::vector<GatheredRay>& gathered, double& cast);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_RAY_TRACING_HEMICIRCLE_GATHER_H_
