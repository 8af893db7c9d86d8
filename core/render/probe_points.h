// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_PROBE_POINTS_H_
#define FLATLIGHT_CORE_RENDER_PROBE_POINTS_H_

#include <cstddef>
#include <vector>

#include "core/scene/scene.h"

namespace flatlight {

// The points of all probes in one row. A point's place in it keys its random numbers.
inline std::vector<const Receiver*> PointsOfProbes(const Scene& scene) {
  std::vector<const Receiver*> points;
  for (const Probe& probe : scene.probes()) {
    for (const Receiver& receiver : probe.receivers) points.push_back(&receiver);
  }
  return points;
}

// For each probe one past the place of its last point.
inline std::vector<std::size_t> EndsOfProbes(const Scene& scene) {
  std::vector<std::size_t> ends;
  std::size_t end = 0;
  for (const Probe& probe : scene.probes()) ends.push_back(end += probe.receivers.size());
  return ends;
}

// What a channel of a result reads, if `computed` channels (1 or all) were computed.
inline std::size_t ComputedChannel(std::size_t channel, std::size_t computed) { return computed == 1 ? 0 : channel; }

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PROBE_POINTS_H_
