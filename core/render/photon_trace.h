// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_PHOTON_TRACE_H_
#define FLATLIGHT_CORE_RENDER_PHOTON_TRACE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/plane/photon_mapping/photon_maps.h"
#include "core/plane/photon_mapping/photon_tracer.h"
#include "core/render/ordered_work.h"
#include "core/statistics/replicates.h"

namespace flatlight {

// What a trace of photons leaves behind.
struct TracedPhotons {
  PhotonMaps::Photons photons;
  std::array<double, kReplicates> paths{};  // Behind those of each replicate.
  double rays = 0;
};

// Traces a range of photons, spread over the replicates, in slices.
class PhotonTrace {
 public:
  // Of so many photons in all, spread as evenly as can be.
  static std::uint64_t PathsOf(std::size_t replicate, std::uint64_t photons) {
    return (photons + kReplicates - 1 - replicate) / kReplicates;
  }

  PhotonTrace() = default;
  // Photons [first, end) of all replicates together.
  PhotonTrace(std::uint32_t seed, std::uint64_t first, std::uint64_t end);

  std::uint64_t first() const { return first_; }
  std::uint64_t end() const { return end_; }
  // Those of one replicate.
  std::uint64_t paths(std::size_t replicate) const { return PathsOf(replicate, end_) - PathsOf(replicate, first_); }
  bool done() const { return work_.done(); }
  double fraction() const { return work_.fraction(); }
  // For about `budget`, until done or cancelled.
  void Advance(const PhotonTracer& tracer, Executor& executor, int max_threads, const Cancellation& cancellation,
               const Clock& clock, Clock::Duration budget);
  // Once, when done.
  TracedPhotons Take(Executor& executor, int max_threads);

 private:
  // Photons of one path number after another.
  struct Chunk {
    std::vector<Photon> photons;
    double rays = 0;
  };
  bool TraceChunk(const PhotonTracer& tracer, std::size_t i, const Cancellation& cancellation);

  std::uint32_t seed_ = 0;
  std::uint64_t first_ = 0, end_ = 0;
  OrderedWork work_{0};
  std::vector<Chunk> chunks_;  // By number, then replicate.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PHOTON_TRACE_H_
