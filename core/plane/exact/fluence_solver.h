// SPDX-License-Identifier: Apache-2.0
// Fluence of direct light: the integral of radiance over all directions, in closed form at a point, and averaged over
// boxes (THEORY 18 B9).
#ifndef FLATLIGHT_CORE_PLANE_EXACT_FLUENCE_SOLVER_H_
#define FLATLIGHT_CORE_PLANE_EXACT_FLUENCE_SOLVER_H_

#include "core/plane/exact/box_mean.h"
#include "core/plane/exact/exact.h"
#include "core/plane/ray_caster.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/scene/scene.h"

namespace flatlight {

// Normalised radiance times radians. Holds working memory: one for each thread.
class FluenceSolver {
 public:
  FluenceSolver(const RayCaster& caster, ExactOptions options, const Triangulation* triangulation);

  // At a point, in the middle of a box: what grows without end near lights is averaged over the box, everything else is
  // of the point.
  Spectrum At(Point2 point, Vector2 box);

  // The mean over a box (see BoxQuadrature): of lights, of whether they are seen, times their exact falloff.
  BoxMean Mean(Point2 center, Vector2 box, const Spectrum& tolerance);

 private:
  Spectrum OfCurves(Point2 point);
  // The share of a light's strength that goes to a point unblocked.
  double Seen(const Light& light, Point2 point) const;

  const RayCaster& caster_;
  ExactOptions options_;
  ExactSolver solver_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_FLUENCE_SOLVER_H_
