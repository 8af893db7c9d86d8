// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_MATERIALS_SCATTERING_H_
#define FLATLIGHT_CORE_PLANE_MATERIALS_SCATTERING_H_

#include <optional>
#include <variant>

#include "core/plane/materials/cosine_lobe.h"
#include "core/plane/materials/local_direction.h"
#include "core/plane/materials/microfacets.h"
#include "core/scene/description.h"
#include "core/scene/material.h"
#include "core/scene/spectrum.h"

namespace flatlight {

// Where the light comes from that leaves in a given direction.
struct ScatterSample {
  LocalDirection in;
  Spectrum weight;     // BRDF |cosine of in| / density; for specular materials the share of light over its chance.
  double density = 0;  // Per radian of `in`; 0 if specular: the one direction.
  // Radiance is larger where light is slower: index of refraction on the side of `out` over that on the side of `in`.
  // To the first power in the plane (THEORY 17 A6). Whoever follows flux leaves it out.
  double compression = 1;
};

// How one side of a curve scatters light. Reciprocal; loses light, never makes any.
class Scattering {
 public:
  // `side`: on which light leaves.
  Scattering(const Material& material, Side side);

  bool specular() const { return std::holds_alternative<Mirror>(kind_) || std::holds_alternative<Border>(kind_); }
  // BRDF, 1/rad, without a cosine. Black if specular: there no pair of directions has a value.
  Spectrum Value(LocalDirection out, LocalDirection in) const;
  // Density of Sample, per radian of `in`. 0 if specular.
  double Density(LocalDirection out, LocalDirection in) const;
  // By two numbers in [0, 1). Absent: this sample counts, and is worth nothing.
  std::optional<ScatterSample> Sample(LocalDirection out, double u, double v) const;

 private:
  struct Border {
    double ratio = 1;  // Index of refraction on the other side over that on this side.
  };
  struct Glossy {
    std::variant<CosineLobe, Microfacets> lobe;
    Spectrum reflectance;
  };
  using Kind = std::variant<Lambertian, Mirror, Border, Glossy>;
  static Kind KindOf(const Material& material, Side side);

  Kind kind_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_MATERIALS_SCATTERING_H_
