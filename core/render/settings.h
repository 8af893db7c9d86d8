// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_SETTINGS_H_
#define FLATLIGHT_CORE_RENDER_SETTINGS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/cache/error_control.h"
#include "core/plane/photon_mapping/kernel.h"

namespace flatlight {

enum class Method : std::uint8_t { kExact, kPathTracing, kRayTracing, kReference, kIrradianceCaching, kPhotonMapping };
enum class Derivatives : std::uint8_t { kNone, kGradient, kHessian };

// What the caller asks for; absent means the method's default. See settings.proto for units and ranges.
// How ray tracing finds derivatives.
enum class Formulation : std::uint8_t { kStratified, kPolyline, kArcLength };

// Where irradiance caching finds what is reflected.
enum class Gather : std::uint8_t { kReference, kRayTracing, kPhotonMap };

struct Settings {
  std::optional<Method> method;
  std::optional<std::uint32_t> samples;
  std::optional<std::uint32_t> max_bounces;
  std::optional<std::uint32_t> seed;
  std::optional<Derivatives> derivatives;
  std::optional<Formulation> formulation;
  std::optional<double> target_error;
  std::optional<double> time_limit;  // s
  std::optional<std::uint32_t> threads;
  // Of irradiance caching.
  std::optional<ErrorControl> error_control;
  std::optional<std::uint32_t> extrapolation;  // Degree, 0 to 2.
  std::optional<double> tolerance;             // Relative error.
  std::optional<std::uint32_t> max_records;
  std::optional<Gather> gather;
  std::optional<bool> neighbour_clamping;
  std::optional<bool> overture;
  // Of photon mapping.
  std::optional<std::uint32_t> photons;
  std::optional<bool> final_gather;
  std::optional<double> bandwidth;  // m
  std::optional<std::uint32_t> neighbours;
  std::optional<Kernel> kernel;
  std::vector<std::string> no_skip;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_SETTINGS_H_
