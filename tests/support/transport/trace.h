// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_TRANSPORT_TRACE_H_
#define FLATLIGHT_TESTS_SUPPORT_TRANSPORT_TRACE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/execution/cancellation.h"
#include "core/plane/path_tracing/path_tracer.h"
#include "core/statistics/replicates.h"

namespace flatlight {

// The first channel of what `samples_per_replicate` paths of each replicate give, in units of the world. `factor`
// scales every path: other than 1 it makes a wrong estimate, for tests that must notice.
inline MeanEstimate Trace(const PathTracer& tracer, const Scene& scene, const Receiver& receiver, std::uint64_t seed,
                          std::uint64_t point, std::uint32_t samples_per_replicate, double factor = 1) {
  const Cancellation never;
  const double scale = scene.frame().radiance_scale * factor;
  const EmitterSight sight = tracer.SightFrom(receiver);
  const PathTracer::Start start(tracer, receiver, sight);
  std::array<double, kReplicates> means{};
  double rays = 0;
  for (std::size_t replicate = 0; replicate < kReplicates; ++replicate) {
    const SampleStream stream(seed, point, replicate);
    std::array<double, kMaxChannels> sums{};
    for (std::uint32_t i = 0; i < samples_per_replicate; ++i) {
      tracer.AddPath(start, stream, i, never, std::span(sums).first(static_cast<std::size_t>(tracer.channels())), rays);
    }
    means[replicate] = scale * sums[0] / samples_per_replicate;
  }
  MeanEstimate estimate = EstimateMean(means, scale * tracer.DirectStep(receiver, sight)[0] / samples_per_replicate);
  estimate.rounding = scale * tracer.DirectRounding(receiver, sight)[0];
  return estimate;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_SUPPORT_TRANSPORT_TRACE_H_
