// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_SOLVED_WORLD_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_SOLVED_WORLD_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/plane/ray_caster.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/radiosity.h"
#include "core/plane/reference/visibility_events.h"

namespace flatlight {

// What panels reflect in a world, whatever its probes are. Its parts refer to each other: it stays where it is.
struct SolvedWorld {
  std::shared_ptr<const RayCaster> caster;
  std::vector<Chart> charts;
  std::vector<std::vector<double>> meetings;
  Events events, kinks;
  std::size_t channels = 1;
  std::optional<std::uint32_t> max_bounces;
  std::unique_ptr<Radiosity> radiosity;

  SolvedWorld() = default;
  SolvedWorld(const SolvedWorld&) = delete;
  SolvedWorld& operator=(const SolvedWorld&) = delete;
  // About so much.
  std::size_t bytes() const;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_SOLVED_WORLD_H_
