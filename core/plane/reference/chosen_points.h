// SPDX-License-Identifier: Apache-2.0
// The points of a scene's probes that a solver has values for.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_CHOSEN_POINTS_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_CHOSEN_POINTS_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/plane/exact/exact.h"
#include "core/scene/scene.h"
#include "core/scene/spectrum.h"

namespace flatlight {

struct ChosenPoints {
  // Of each probe at most so many, spread evenly. The scene must outlive this.
  ChosenPoints(const Scene& scene, std::size_t most) {
    for (std::size_t p = 0; p < scene.probes().size(); ++p) {
      const std::vector<Receiver>& all = scene.probes()[p].receivers;
      const std::size_t count = std::min(all.size(), most);
      for (std::size_t i = 0; i < count; ++i) {
        receivers.push_back(&all[(2 * i + 1) * all.size() / (2 * count)]);
        probes.push_back(p);
      }
      of_probe.push_back(static_cast<double>(count));
    }
  }

  // By probe: of the points' irradiance.
  std::vector<Spectrum> Means(const std::vector<ExactValue>& values) const {
    std::vector<Spectrum> means(of_probe.size());
    for (std::size_t i = 0; i < receivers.size(); ++i)
      means[probes[i]] = means[probes[i]] + (1 / of_probe[probes[i]]) * values[i].irradiance;
    return means;
  }

  std::vector<const Receiver*> receivers;
  std::vector<std::size_t> probes;  // By point: the probe's number.
  std::vector<double> of_probe;     // By probe: how many points.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_CHOSEN_POINTS_H_
