// SPDX-License-Identifier: Apache-2.0
#include "core/render/photon_source.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/plane/box.h"

namespace flatlight {
namespace {

// Nothing is seen in a picture.
Box Nowhere() {
  Box box;
  box.Add(Point2{});
  return box;
}

std::uint32_t MostBounces(const Settings& settings) {
  return settings.max_bounces.value_or(std::numeric_limits<std::uint32_t>::max());
}

// What a ray's end finds is reflected once more.
std::optional<std::uint32_t> TracedBounces(const Settings& settings) {
  if (!settings.max_bounces) return std::nullopt;
  return *settings.max_bounces - 1;
}

}  // namespace

PhotonSource::PhotonSource(const std::shared_ptr<const Scene>& scene, const std::shared_ptr<const RayCaster>& caster,
                           const Settings& settings)
    : stretches_(caster->scene()),
      light_(caster, Nowhere(), TracedBounces(settings), kLeastPhotonShare),
      tracer_(light_, caster->scene(), *scene, stretches_, PhotonPurpose::kReflectors, MostBounces(settings)),
      trace_(settings.seed.value_or(0), 0, std::max<std::uint64_t>(*settings.photons, kReplicates)) {}

void PhotonSource::Advance(Executor& executor, int max_threads, const Cancellation& cancellation, const Clock& clock,
                           Clock::Duration budget) {
  if (done()) return;
  // Of what shines nowhere there is no photon.
  if (!light_.sources().empty()) {
    trace_.Advance(tracer_, executor, max_threads, cancellation, clock, budget);
    if (!trace_.done()) return;
  }
  TracedPhotons photons = trace_.Take(executor, max_threads);
  rays_ = photons.rays;
  DensityOptions options;
  options.kernel = Kernel::kBox;
  maps_ = std::make_unique<const PhotonMaps>(stretches_, std::move(photons.photons), photons.paths, options, executor,
                                             max_threads);
  irradiance_.emplace(*maps_, PooledIrradiance::Quantity::kIrradiance);
  doubt_.emplace(*maps_, PooledIrradiance::Quantity::kDoubt);
}

}  // namespace flatlight
