// SPDX-License-Identifier: Apache-2.0
#include "core/render/photon_trace.h"

#include <algorithm>

#include "core/sampling/sample_stream.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kChunkPaths = 256;

}  // namespace

PhotonTrace::PhotonTrace(std::uint32_t seed, std::uint64_t first, std::uint64_t end)
    : seed_(seed), first_(first), end_(end) {
  std::uint64_t most_paths = 0;
  for (std::size_t r = 0; r < kReplicates; ++r) most_paths = std::max(most_paths, paths(r));
  chunks_.resize((most_paths + kChunkPaths - 1) / kChunkPaths * kReplicates);
  work_ = OrderedWork(chunks_.size());
}

bool PhotonTrace::TraceChunk(const PhotonTracer& tracer, std::size_t i, const Cancellation& cancellation) {
  Chunk& chunk = chunks_[i];
  chunk = {};
  const std::size_t r = i % kReplicates;
  const SampleStream stream(seed_, ~std::uint64_t{1}, r);  // No probe has a point of this number.
  const std::uint64_t begin = PathsOf(r, first_) + i / kReplicates * kChunkPaths;
  const std::uint64_t end = std::min(begin + kChunkPaths, PathsOf(r, end_));
  for (std::uint64_t path = begin; path < end; ++path) {
    if (path % 64 == 0 && cancellation.cancelled()) return false;
    chunk.rays += tracer.Trace(stream, static_cast<std::uint32_t>(path), chunk.photons);
  }
  return true;
}

void PhotonTrace::Advance(const PhotonTracer& tracer, Executor& executor, int max_threads,
                          const Cancellation& cancellation, const Clock& clock, Clock::Duration budget) {
  work_.Advance(executor, max_threads, cancellation, clock, budget, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      if (!TraceChunk(tracer, i, cancellation)) return false;
    return true;
  });
}

TracedPhotons PhotonTrace::Take(Executor& executor, int max_threads) {
  TracedPhotons traced;
  for (std::size_t r = 0; r < kReplicates; ++r) traced.paths[r] = static_cast<double>(paths(r));
  executor.ParallelFor(kReplicates, max_threads, [&](std::size_t r) {
    std::vector<Photon>& photons = traced.photons[r];
    for (std::size_t i = r; i < chunks_.size(); i += kReplicates)
      photons.insert(photons.end(), chunks_[i].photons.begin(), chunks_[i].photons.end());
  });
  for (const Chunk& chunk : chunks_) traced.rays += chunk.rays;
  chunks_.clear();
  return traced;
}

}  // namespace flatlight
