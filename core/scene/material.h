// SPDX-License-Identifier: Apache-2.0
// How curves scatter light, as a scene says it. core/plane/materials has the mathematics.
#ifndef FLATLIGHT_CORE_SCENE_MATERIAL_H_
#define FLATLIGHT_CORE_SCENE_MATERIAL_H_

#include <variant>

#include "core/scene/spectrum.h"

namespace flatlight {

// BRDF reflectance / 2.
struct Lambertian {
  Spectrum reflectance;
};

struct Mirror {
  Spectrum reflectance;
};

// A smooth border between two media. Light splits by Fresnel's equations for unpolarised light.
struct Dielectric {
  double ior = 1;  // Index of refraction behind the curve (on its back), over that in front of it.
};

// A lobe reflectance cos^exponent(alpha) / W about the mirror direction, with W = integral of cos^(exponent + 1): what
// is reflected at normal incidence is `reflectance`, and less elsewhere.
struct Phong {
  Spectrum reflectance;
  double exponent = 1;  // > 0.
};

// Facets that are mirrors, with normals of the plane's GGX distribution. Light between facets is not counted.
struct Conductor {
  Spectrum reflectance;  // Of a facet, in every direction.
  double alpha = 1;      // In (0, 1].
};

// The same on both sides of a curve, but for Dielectric.
using Material = std::variant<Lambertian, Mirror, Dielectric, Phong, Conductor>;

// Whether light leaves in one direction, or two, and not in a fan.
inline bool IsSpecular(const Material& material) {
  return std::holds_alternative<Mirror>(material) || std::holds_alternative<Dielectric>(material);
}

// No direction reflects (and transmits) more.
Spectrum LargestAlbedo(const Material& material);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_MATERIAL_H_
