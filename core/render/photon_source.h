// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_PHOTON_SOURCE_H_
#define FLATLIGHT_CORE_RENDER_PHOTON_SOURCE_H_

#include <cstdint>
#include <memory>
#include <optional>

#include "core/plane/light_tracing/light_tracer.h"
#include "core/plane/photon_mapping/photon_maps.h"
#include "core/plane/photon_mapping/photon_tracer.h"
#include "core/plane/photon_mapping/stretches.h"
#include "core/plane/ray_caster.h"
#include "core/plane/ray_tracing/ray_tree.h"
#include "core/render/photon_trace.h"
#include "core/render/settings.h"

namespace flatlight {

// One photon map of what curves reflect, for methods whose rays end there.
class PhotonSource {
 public:
  // The caster's scene has the world of `scene`. Of settings those of photons, bounces and seed.
  PhotonSource(const std::shared_ptr<const Scene>& scene, const std::shared_ptr<const RayCaster>& caster,
               const Settings& settings);
  PhotonSource(const PhotonSource&) = delete;
  PhotonSource& operator=(const PhotonSource&) = delete;

  // For about `budget`, until done or cancelled.
  void Advance(Executor& executor, int max_threads, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget);
  bool done() const { return maps_ != nullptr; }
  double fraction() const { return done() ? 1 : trace_.fraction(); }
  std::uint64_t traced() const { return done() ? trace_.end() : 0; }
  double rays() const { return rays_; }  // Cast.

  // Once it is done, of a tree for the same bounces: what its rays bring if they end in the map, and what that may be
  // off by. This must outlive them.
  RayTree EndOf(const RayTree& tree) const { return tree.EndedBy(*irradiance_); }
  RayTree DoubtOf(const RayTree& tree) const { return tree.EndedBy(*doubt_, Emission::kLeftOut); }

 private:
  Stretches stretches_;
  LightTracer light_;
  PhotonTracer tracer_;
  PhotonTrace trace_;
  std::unique_ptr<const PhotonMaps> maps_;
  std::optional<PooledIrradiance> irradiance_, doubt_;
  double rays_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PHOTON_SOURCE_H_
