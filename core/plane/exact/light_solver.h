// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_EXACT_LIGHT_SOLVER_H_
#define FLATLIGHT_CORE_PLANE_EXACT_LIGHT_SOLVER_H_

#include "core/plane/exact/exact.h"
#include "core/plane/ray_caster.h"
#include "core/scene/light.h"
#include "core/scene/scene.h"

namespace flatlight {

// Direct irradiance, with its derivatives, of lights without a surface (THEORY 18 B4; spots are derived here). At the
// edge of a hard shadow irradiance jumps, and derivatives are those of the side the receiver is on.
class LightSolver {
 public:
  // Both must outlive this.
  LightSolver(const RayCaster& caster, const ExactOptions& options) : caster_(caster), options_(options) {}

  // Adds the light of all lights that nothing blocks. Safe to call from several threads.
  void Add(const Receiver& receiver, ExactValue& value) const;

 private:
  void AddPoint(const PointLight& light, const Receiver& receiver, ExactValue& value) const;
  void AddDirectional(const DirectionalLight& light, const Receiver& receiver, ExactValue& value) const;
  // The light's strength times what one of unit strength gives, and their errors: irradiance, first, second derivative.
  // `rotation`: of the unit irradiance with the normal.
  void AddRotation(const Spectrum& strength, double rotation, double error, ExactValue& value) const;
  void AddTimes(const Spectrum& strength, const double (&unit)[3], const double (&error)[3], ExactValue& value) const;

  const RayCaster& caster_;
  ExactOptions options_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_LIGHT_SOLVER_H_
