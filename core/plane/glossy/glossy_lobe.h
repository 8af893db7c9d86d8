// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_LOBE_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_LOBE_H_

#include <algorithm>
#include <optional>

#include "core/math/power.h"
#include "core/plane/glossy/power_table.h"
#include "core/plane/materials/local_direction.h"
#include "core/scene/material.h"

namespace flatlight {

// A phong lobe as quadrature needs to know it.
class GlossyLobe {
 public:
  explicit GlossyLobe(double exponent);
  // Absent if the material has none.
  static std::optional<GlossyLobe> Of(const Material& material);

  // BRDF over reflectance, 1/rad.
  double Value(LocalDirection out, LocalDirection in) const {
    const double cosine = CosineOfAngle(out, in);
    if (cosine > powers_.least()) return factor_ * powers_.Power(std::min(cosine, 1.0));
    return stops_ && cosine > 0 ? factor_ * UnitPower(cosine, exponent_) : 0;
  }
  // Of the angle between one direction and the other one's reflection: positive where the lobe is.
  static double CosineOfAngle(LocalDirection out, LocalDirection in) {
    return out.cosine * in.cosine - out.sine * in.sine;
  }
  // Within so many radians it is as good as a polynomial of low degree.
  double width() const { return width_; }
  // Whether it stops, a right angle from its axis, so abruptly that quadrature has to know the place.
  bool stops() const { return stops_; }

 private:
  double exponent_;
  PowerTable powers_;
  double factor_;
  double width_;
  bool stops_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_LOBE_H_
