// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "tests/bench/peers/ray_peer.h"

namespace flatlight {
namespace {

class LinearScan : public RayPeer {
 public:
  explicit LinearScan(const RayScene& scene) : scene_(scene) {}
  const char* name() const override { return "linear scan"; }
  bool single_precision() const override { return false; }

  void Cast(std::size_t first, std::size_t count, PeerHit* hits) override {
    for (std::size_t i = 0; i < count; ++i) hits[i] = ClosestHit(scene_.rays[first + i]);
  }

 private:
  PeerHit ClosestHit(const PeerRay& ray) const {
    PeerHit hit;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t s = 0; s < scene_.segments.size(); ++s) {
      const SegmentDescription& segment = scene_.segments[s];
      // origin + t * direction = a + u * (b - a)
      const Vector2 along = segment.b - segment.a, to_a = segment.a - ray.origin;
      const double determinant = Cross(ray.direction, along);
      const double t = Cross(to_a, along) / determinant, u = Cross(to_a, ray.direction) / determinant;
      if (s == ray.own || !(t > 0 && t < nearest && u >= 0 && u <= 1)) continue;
      nearest = t;
      hit = {s, t};
    }
    return hit;
  }

  RayScene scene_;
};

}  // namespace

std::unique_ptr<RayPeer> MakeLinearScan(const RayScene& scene) { return std::make_unique<LinearScan>(scene); }

}  // namespace flatlight
