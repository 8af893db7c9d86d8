// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_FIELD_H_
#define FLATLIGHT_CORE_RENDER_FIELD_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// Values at the points of one probe, in world units. Arrays are flat (point, then channel); one that was not asked for,
// or that the method does not give, is empty.
struct ProbeField {
  std::vector<double> irradiance;      // W/m
  std::vector<double> standard_error;  // W/m
  std::vector<double> gradient;        // W/m^2
  std::vector<double> gradient_error;
  std::vector<double> hessian;  // W/m^3
  std::vector<double> hessian_error;
  std::vector<double> rotation_gradient;  // W/(m rad)
  std::vector<double> rotation_gradient_error;
  std::vector<double> samples;           // Paths; one value a point.
  std::vector<double> irradiance_error;  // W/m; bounds, of a method that states one for each value.
  std::vector<double> estimated_error;   // W/m; of a biased method, no bound.
  std::vector<double> estimated_bias;    // W/m; of a biased method that has standard errors beside, no bound.
};

// A cache record, in world units. Arrays by channel; one that is not known is empty.
struct RecordField {
  Point2 position;
  Vector2 normal;
  std::string curve;  // Its name; empty for free points.
  Side side = Side::kFront;
  std::vector<double> irradiance;    // W/m
  std::vector<double> gradient;      // W/m^2
  std::vector<double> hessian;       // W/m^3
  std::vector<double> third;         // Derivatives: W/m^4,
  std::vector<double> fourth;        // W/m^5
  std::optional<double> arc_length;  // Along the curve; absent for free points. m
  double noise = 0;                  // Of irradiance. W/m
  double unknown_jump = 0;           // W/m^2
  // What it sees, see core/cache/record.h.
  std::optional<double> inverse_distance;    // 1/m
  std::vector<double> radiometric;           // W/m^3
  double geometric = 0;                      // 1/m^2
  double turning = 0;                        // 1/m^2
  double left_radius = 0, right_radius = 0;  // m, against and along the track.
  std::uint32_t wave = 0;
};

// The state of a rendering: cumulative, a newer one replaces an older one.
struct Field {
  std::vector<ProbeField> probes;
  std::optional<double> error_bound;  // Deterministic methods: no irradiance is further from the truth. W/m.
  double rays = 0;
  std::optional<double> photons;  // Paths of light from its sources, of photon mapping.
  // In the order in which they were made: a newer field has more of them, and may have other radii.
  std::vector<RecordField> records;
  std::size_t reused_records = 0;  // The first so many are of an earlier job.
};

struct RenderProgress {
  double fraction = 0;  // In [0, 1].
  double samples = 0;   // Paths of the point that has most.
  double rays = 0;
  double records = 0;  // Of irradiance caching, in whole waves.
  std::optional<double> remaining_seconds;
  // Largest over the points: standard error or bound / max(irradiance, 1 % of the probe's mean).
  std::optional<double> relative_error;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_FIELD_H_
