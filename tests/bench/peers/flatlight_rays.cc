// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"
#include "tests/bench/peers/flatlight_scene.h"
#include "tests/bench/peers/ray_peer.h"

namespace flatlight {
namespace {

std::shared_ptr<const Scene> SceneOf(const std::vector<SegmentDescription>& segments) {
  SceneDescription description = BlackSegments(segments);
  ProbeDescription probe;  // A scene needs one.
  probe.name = "middle";
  probe.points = {{{0.5, 0.5}, {0, 1}}};
  description.probes = {probe};
  return BuiltOrExit(description);
}

// Elements have the numbers of the segments.
static_assert(static_cast<std::uint32_t>(ElementId::kNone) == kNoSegment);

class FlatlightRays : public RayPeer {
 public:
  explicit FlatlightRays(const RayScene& scene) : caster_(SceneOf(scene.segments)) {
    const Frame& frame = caster_.scene().frame();
    for (const PeerRay& ray : scene.rays) {
      const Vector2 place = (ray.origin - frame.origin) / frame.scale;
      rays_.push_back({{{place.x, place.y}, static_cast<ElementId>(ray.own)}, ray.direction});
    }
  }
  const char* name() const override { return "flatlight"; }
  bool single_precision() const override { return false; }

  void Cast(std::size_t first, std::size_t count, PeerHit* hits) override {
    for (std::size_t i = 0; i < count; ++i) {
      const Ray& ray = rays_[first + i];
      hits[i] = ToPeerHit(caster_.ClosestHit(ray.from, ray.direction));
    }
  }

 protected:
  PeerHit ToPeerHit(const std::optional<Hit>& hit) const {
    if (!hit) return {};
    return {static_cast<std::uint32_t>(hit->element), caster_.scene().frame().scale * hit->distance};
  }

  RayCaster caster_;
  std::vector<Ray> rays_;
};

// As a gather would: some hundred rays a call.
class FlatlightBatches : public FlatlightRays {
 public:
  using FlatlightRays::FlatlightRays;
  const char* name() const override { return "flatlight batches"; }

  void Cast(std::size_t first, std::size_t count, PeerHit* hits) override {
    for (std::size_t done = 0; done < count; done += kBatch) {
      const std::size_t now = std::min(kBatch, count - done);
      caster_.ClosestHits(std::span(rays_).subspan(first + done, now), std::span(found_).first(now));
      for (std::size_t i = 0; i < now; ++i) hits[done + i] = ToPeerHit(found_[i]);
    }
  }

 private:
  static constexpr std::size_t kBatch = 256;
  std::array<std::optional<Hit>, kBatch> found_;
};

}  // namespace

std::unique_ptr<RayPeer> MakeFlatlightRays(const RayScene& scene) { return std::make_unique<FlatlightRays>(scene); }
std::unique_ptr<RayPeer> MakeFlatlightBatches(const RayScene& scene) {
  return std::make_unique<FlatlightBatches>(scene);
}

}  // namespace flatlight
