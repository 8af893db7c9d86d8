// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_REFLECTED_SERIES_H_
#define FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_REFLECTED_SERIES_H_

#include <array>
#include <vector>

#include "core/cache/record.h"
#include "core/plane/irradiance_caching/light_kinks.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/outlook.h"
#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/stretch.h"
#include "core/scene/scene.h"

namespace flatlight {

// Light that curves reflect, as the panels of a deterministic solution have it. All must outlive this.
struct ReflectedLight {
  const PanelMesh* mesh = nullptr;
  const PanelLight* light = nullptr;
};

// Irradiance from it with its derivatives along a receiver that moves on a line or circle. What is seen of each panel
// is integrated between ends that move with the receiver, all as power series of its arc length: Gauss quadrature of an
// integrand's derivatives is that of its integral.
class ReflectedSeries {
 public:
  ReflectedSeries(const Scene& scene, const std::vector<Chart>& charts, const ReflectedLight& reflected);

  // `pieces`: what the receiver sees. Without `occlusion` their ends stay where they are on the curves.
  std::array<Spectrum, kRecordOrders> At(const Receiver& receiver, const std::vector<VisiblePiece>& pieces,
                                         bool occlusion = true) const;
  const LightKinks& kinks() const { return kinks_; }

 private:
  const Scene& scene_;
  const std::vector<Chart>& charts_;
  ReflectedLight reflected_;
  PointCount count_;
  LightKinks kinks_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_REFLECTED_SERIES_H_
