// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_MATERIALS_FRESNEL_H_
#define FLATLIGHT_CORE_PLANE_MATERIALS_FRESNEL_H_

#include "core/plane/materials/local_direction.h"

namespace flatlight {

// How light splits at a smooth border between two media.
struct FresnelSplit {
  double reflected = 1;        // Share of the flux that is reflected, in [0, 1]; the rest crosses.
  LocalDirection transmitted;  // On the other side. Of no meaning if all is reflected.
};

// `in`: on the near side. `ratio`: index of refraction on the far side over that on the near side, > 0. Snell's law,
// and Fresnel's equations for unpolarised light: the mean of both polarisations.
FresnelSplit SplitAtBorder(LocalDirection in, double ratio);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_MATERIALS_FRESNEL_H_
