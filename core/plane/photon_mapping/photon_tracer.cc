// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/photon_tracer.h"

#include <variant>

namespace flatlight {

PhotonTracer::PhotonTracer(const LightTracer& tracer, const Scene& scene, const Scene& probes,
                           const Stretches& stretches, PhotonPurpose purpose, std::uint32_t most_bounces)
    : tracer_(tracer),
      scene_(scene),
      stretches_(stretches),
      purpose_(purpose),
      most_bounces_(most_bounces),
      has_probe_(scene.curves().size(), 0) {
  for (const Probe& probe : probes.probes()) {
    for (const Receiver& receiver : probe.receivers) {
      if (receiver.element != ElementId::kNone)
        has_probe_[static_cast<std::size_t>(scene.element(receiver.element).curve)] = 1;
    }
  }
}

double PhotonTracer::Trace(const SampleStream& stream, std::uint32_t index, std::vector<Photon>& photons) const {
  return tracer_.Follow(stream, index, [&](const LightStep& step) {
    if (!step.hit) return;
    const CurveId id = scene_.element(step.hit->element).curve;
    const Curve& curve = scene_.curve(id);
    const bool diffuse = std::holds_alternative<Lambertian>(curve.material);
    // What reflects adds a bounce.
    const bool wanted = purpose_ == PhotonPurpose::kReflectors
                            ? diffuse && !curve.reflectance.IsBlack() && step.depth < most_bounces_
                            : has_probe_[static_cast<std::size_t>(id)] != 0;
    if (!wanted) return;
    const Side side = Dot(step.hit->normal, step.direction) < 0 ? Side::kFront : Side::kBack;
    const SidePlace place = stretches_.Locate(step.hit->element, step.hit->position, side);
    photons.push_back({place.side, place.at, step.flux, step.depth});
  });
}

}  // namespace flatlight
