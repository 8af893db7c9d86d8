// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_LIGHT_KINKS_H_
#define FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_LIGHT_KINKS_H_

#include <cstddef>
#include <vector>

#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/scene/scene.h"

namespace flatlight {

// Places on curves at which the light that they reflect jumps, or its slope or bend: ends of panels whose polynomials
// do not go on into one another, as at a visibility event of the curve itself. Where the edge of something nearer
// passes before such a place, a derivative of irradiance jumps.
class LightKinks {
 public:
  // `elements`: their number.
  LightKinks(std::size_t elements, const PanelMesh& mesh, const PanelLight& light);

  // How many are below a number of the element's chart.
  std::size_t Below(ElementId element, Side side, double u) const;

 private:
  std::vector<std::vector<double>> places_;  // By element and side, in order.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_LIGHT_KINKS_H_
