// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/glossy_lobe.h"

#include <cmath>
#include <variant>

#include "core/plane/materials/cosine_lobe.h"

namespace flatlight {
namespace {

// cos^n is about exp(-n angle^2 / 2).
constexpr double kWidths = 2;
// An n-fold root at the end of a stretch as wide as the lobe is beyond the digits that count from here on.
constexpr double kSmooth = 14;

}  // namespace

GlossyLobe::GlossyLobe(double exponent)
    : exponent_(exponent),
      powers_(exponent),
      factor_(1 / CosinePowerIntegral(exponent + 1)),
      width_(kWidths / std::sqrt(exponent + 1)),
      stops_(exponent < kSmooth) {}

std::optional<GlossyLobe> GlossyLobe::Of(const Material& material) {
  const auto* phong = std::get_if<Phong>(&material);
  if (phong == nullptr) return std::nullopt;
  return GlossyLobe(phong->exponent);
}

}  // namespace flatlight
