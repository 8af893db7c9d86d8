// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/field_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "server/store/error.h"

namespace flatlight {
namespace {

struct Quantity {
  const char* name;
  std::vector<double> ProbeField::*values;
};

constexpr Quantity kQuantities[] = {
    {"irradiance", &ProbeField::irradiance},
    {"standard_error", &ProbeField::standard_error},
    {"gradient", &ProbeField::gradient},
    {"gradient_error", &ProbeField::gradient_error},
    {"hessian", &ProbeField::hessian},
    {"hessian_error", &ProbeField::hessian_error},
    {"rotation_gradient", &ProbeField::rotation_gradient},
    {"rotation_gradient_error", &ProbeField::rotation_gradient_error},
    {"samples", &ProbeField::samples},
    {"irradiance_error", &ProbeField::irradiance_error},
    {"estimated_error", &ProbeField::estimated_error},
    {"estimated_bias", &ProbeField::estimated_bias},
};

absl::Status NotFinite(const std::string& what, double value) {
  return MakeError(absl::StatusCode::kInternal, "NOT_FINITE",
                   what + (std::isnan(value) ? " is not a number" : " is infinite") +
                       "; the scene's sizes or radiances may be too large or too small to compute with");
}

}  // namespace

absl::Status CheckFinite(const SceneOutline& scene, const Field& field) {
  for (std::size_t probe = 0; probe < field.probes.size(); ++probe) {
    for (const Quantity& quantity : kQuantities) {
      const std::vector<double>& values = field.probes[probe].*quantity.values;
      const auto bad =
          std::find_if_not(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
      if (bad == values.end()) continue;
      const std::size_t width = values.size() / scene.probes[probe].points();
      const auto point = static_cast<std::size_t>(bad - values.begin()) / width;
      return NotFinite(
          "probe \"" + scene.probes[probe].name + "\": " + quantity.name + " at point " + std::to_string(point), *bad);
    }
  }
  if (!std::isfinite(field.error_bound.value_or(0))) return NotFinite("error_bound", *field.error_bound);
  return absl::OkStatus();
}

}  // namespace flatlight
