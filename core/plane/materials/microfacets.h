// SPDX-License-Identifier: Apache-2.0
// Mirror facets whose slopes have the plane's GGX distribution: the normals of an ellipse (THEORY 18 B10; Smith's
// shadowing as in Heitz 2014, visible normals as in Heitz 2018).
#ifndef FLATLIGHT_CORE_PLANE_MATERIALS_MICROFACETS_H_
#define FLATLIGHT_CORE_PLANE_MATERIALS_MICROFACETS_H_

#include <optional>

#include "core/plane/materials/local_direction.h"

namespace flatlight {

class Microfacets {
 public:
  // alpha: in (0, 1]; the distribution's width, in slopes.
  explicit Microfacets(double alpha) : alpha_(alpha) {}

  // BRDF over the facets' reflectance, 1/rad. Both directions in front.
  double Value(LocalDirection out, LocalDirection in) const;
  // Of Sample: per radian of `in`.
  double Density(LocalDirection out, LocalDirection in) const;
  // The reflection on a facet that is visible from `out`, chosen by the first number in [0, 1). Absent where it leads
  // below the curve: that sample counts, and is worth nothing.
  std::optional<LocalDirection> Sample(LocalDirection out, double u, double) const;

 private:
  // The facet's normal that reflects one direction into the other.
  static LocalDirection HalfWay(LocalDirection out, LocalDirection in);
  // Density of facets by the angle of their normal; cos of it is the share of length: integral of D cos = 1.
  double Distribution(LocalDirection normal) const;
  double Lambda(LocalDirection direction) const;

  double alpha_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_MATERIALS_MICROFACETS_H_
