// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_FLUX_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_FLUX_H_

#include <cstdint>
#include <optional>
#include <string>

#include "core/scene/description.h"

namespace flatlight::stress {

struct FluxSide {
  std::string curve;
  Side side = Side::kFront;
  double absorptance = 1;  // What share of the light that arrives is counted.
};

struct Flux {
  double watts = 0;
  double variance = 0;
};

// The flux that arrives on one side of a curve, all bounces: path tracing at two random places in each of `strata`
// equal parts of it, an unbiased estimate whose variance the pairs tell. Absent if the scene is refused.
std::optional<Flux> MeasureFlux(SceneDescription scene, const FluxSide& side, int strata, std::uint32_t samples,
                                std::uint64_t seed);

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_FLUX_H_
