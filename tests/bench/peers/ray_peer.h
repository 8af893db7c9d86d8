// SPDX-License-Identifier: Apache-2.0
// A program that finds the first segment on a ray.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_RAY_PEER_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_RAY_PEER_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/description.h"

namespace flatlight {

inline constexpr std::uint32_t kNoSegment = 0xffffffff;

// Like the segments, in coordinates that single precision represents: so all programs are asked the same.
struct PeerRay {
  Point2 origin;
  Vector2 direction;               // Unit, to single precision.
  std::uint32_t own = kNoSegment;  // The segment that the origin lies on, which the ray does not hit.
};

struct PeerHit {
  std::uint32_t segment = kNoSegment;
  double distance = 0;
};

struct RayScene {
  std::vector<SegmentDescription> segments;
  std::vector<PeerRay> rays;
  bool on_segments = false;  // Whether the rays have `own`.
};

class RayPeer {
 public:
  virtual ~RayPeer() = default;
  virtual const char* name() const = 0;
  virtual bool single_precision() const { return true; }
  // If above 0, the program does not know which segment a ray leaves: it takes no hit nearer than this.
  virtual double near() const { return 0; }
  // Casts the scene's rays first, first + 1, ..., one after the other.
  virtual void Cast(std::size_t first, std::size_t count, PeerHit* hits) = 0;
};

// They keep a copy of the scene in their own form.
std::unique_ptr<RayPeer> MakeFlatlightRays(const RayScene& scene);
std::unique_ptr<RayPeer> MakeFlatlightBatches(const RayScene& scene);
// Tests every segment, in double precision: what the others are checked against.
std::unique_ptr<RayPeer> MakeLinearScan(const RayScene& scene);
std::unique_ptr<RayPeer> MakeBox2dWorld(const RayScene& scene);
std::unique_ptr<RayPeer> MakeBox2dTree(const RayScene& scene);
std::unique_ptr<RayPeer> MakeEmbreeQuads(const RayScene& scene);
// For rays from segments: `near` is above 0.
std::unique_ptr<RayPeer> MakeEmbreeQuadsNear(const RayScene& scene);
std::unique_ptr<RayPeer> MakeEmbreeUserGeometry(const RayScene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_RAY_PEER_H_
