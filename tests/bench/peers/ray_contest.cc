// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/ray_contest.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "tests/bench/peers/ray_peer.h"
#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

constexpr std::size_t kRays = 1 << 14;  // More than branch prediction learns.

double Single(double value) { return static_cast<double>(static_cast<float>(value)); }
Point2 Single(Point2 p) { return {Single(p.x), Single(p.y)}; }

RayScene MakeScene(int count, double length, bool on_segments) {
  RayScene scene;
  scene.on_segments = on_segments;
  scene.segments = ScatteredSegments(count, length, 1);
  for (SegmentDescription& segment : scene.segments) segment = {Single(segment.a), Single(segment.b)};
  RandomNumbers random(2);
  for (std::size_t i = 0; i < kRays; ++i) {
    PeerRay ray;
    const double angle = 2 * std::numbers::pi * random.Next();
    ray.direction = {Single(std::cos(angle)), Single(std::sin(angle))};
    ray.origin = {random.Next(), random.Next()};
    if (on_segments) {
      ray.own = static_cast<std::uint32_t>(random.Next() * count);
      const SegmentDescription& segment = scene.segments[ray.own];
      ray.origin = segment.a + random.Next() * (segment.b - segment.a);
    }
    ray.origin = Single(ray.origin);
    scene.rays.push_back(ray);
  }
  return scene;
}

// Two segments at one distance, to the accuracy of the program, are the same answer.
bool SameHit(const PeerHit& hit, const PeerHit& other, double tolerance) {
  if (hit.segment == other.segment) return true;
  return hit.segment != kNoSegment && other.segment != kNoSegment &&
         std::abs(hit.distance - other.distance) <= tolerance;
}

double DifferingShare(const std::vector<PeerHit>& hits, const std::vector<PeerHit>& others, double tolerance) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < others.size(); ++i) differing += SameHit(hits[i], others[i], tolerance) ? 0 : 1;
  return static_cast<double>(differing) / static_cast<double>(others.size());
}

std::vector<PeerHit> CastAll(RayPeer& peer, std::size_t count) {
  std::vector<PeerHit> hits(count);
  peer.Cast(0, count, hits.data());
  return hits;
}

// As many rays as are checked in a moment.
std::size_t CheckedRays(int size) {
  return std::clamp<std::size_t>(400'000'000 / static_cast<std::size_t>(size), 1024, kRays);
}

struct Case {
  std::string scene;
  int size;
  LengthRule rule;
};

// The share of hits that single precision may change.
double AllowedShare(const Case& at, const RayPeer& peer) {
  if (!peer.single_precision()) return 0;
  const double length = at.rule.For(at.size), step = 0x1p-24;  // Half the space between numbers below 1.
  // A ray goes on average pi / (2 n length), and each unit of area has 2 n ends of segments: so it passes
  // 2 pi step / length ends as closely as they are rounded. Times 16, for operations in a row round more often.
  double share = 2 * std::numbers::pi * 16 * step / length;
  if (peer.near() > 0) {
    // Hits as near as that, twice as many as on average; and half of the rays that leave so flatly that the rounding of
    // their origin moves it that far along them.
    const double hits_a_length = 2 / std::numbers::pi * length * at.size;
    share += 2 * hits_a_length * peer.near() + step / (std::numbers::pi * peer.near());
  }
  // At least three rays.
  return std::max(3.5 / static_cast<double>(CheckedRays(at.size)), share);
}

// Flatlight against a search that leaves nothing out; as many rays as that does in a moment.
bool CheckAgainstLinearScan(const Case& at, const RayScene& scene, const std::vector<PeerHit>& hits) {
  const std::size_t count = std::clamp<std::size_t>(20'000'000 / scene.segments.size(), 100, kRays);
  const std::vector<PeerHit> truth = CastAll(*MakeLinearScan(scene), count);
  const double share = DifferingShare(hits, truth, 1e-12);
  if (share == 0) return true;
  std::fprintf(stderr, "peers: %s, %d segments of %s: Flatlight differs from a linear scan in %.2g of %zu rays\n",
               at.scene.c_str(), at.size, at.rule.Name().c_str(), share, count);
  return false;
}

bool Check(const Case& at, const RayPeer& peer, double share) {
  const double allowed = AllowedShare(at, peer);
  if (share <= allowed) return true;
  std::fprintf(stderr, "peers: %s, %d segments of %s: %s and Flatlight differ in %.2g of the rays; allowed: %.2g\n",
               at.scene.c_str(), at.size, at.rule.Name().c_str(), peer.name(), share, allowed);
  return false;
}

bool RunCase(const Case& at, bool on_segments, const ContestOptions& options, std::vector<Row>& rows) {
  const RayScene scene = MakeScene(at.size, at.rule.For(at.size), on_segments);
  std::vector<std::unique_ptr<RayPeer>> peers;
  peers.push_back(MakeFlatlightRays(scene));
  peers.push_back(MakeFlatlightBatches(scene));
  peers.push_back(MakeBox2dTree(scene));
  peers.push_back(MakeBox2dWorld(scene));
  peers.push_back(MakeEmbreeUserGeometry(scene));
  peers.push_back(MakeEmbreeQuads(scene));
  if (on_segments) peers.push_back(MakeEmbreeQuadsNear(scene));
  const std::vector<PeerHit> hits = CastAll(*peers[0], kRays);
  bool agree = CheckAgainstLinearScan(at, scene, hits);

  std::vector<Row> found;
  std::vector<Contestant> contestants;
  std::vector<PeerHit> sink(kRays);
  for (const std::unique_ptr<RayPeer>& peer : peers) {
    // A distance of single precision is off by more where the ray grazes, which is where it also misses.
    const double share =
        DifferingShare(hits, CastAll(*peer, CheckedRays(at.size)), peer->single_precision() ? 1e-5 : 0);
    agree = Check(at, *peer, share) && agree;
    found.push_back({peer->name(), at.scene, at.size, at.rule.Name(), "rays/s", {}, share});
    contestants.push_back({peer->name(), [&peer, &sink](std::size_t first, std::size_t count) {
                             peer->Cast(first, count, sink.data());
                           }});
  }
  if (options.timing) {
    const std::vector<Timing> timings = TimeInTurns(contestants, kRays, options.turns);
    for (std::size_t i = 0; i < found.size(); ++i) found[i].timing = timings[i];
  }
  rows.insert(rows.end(), found.begin(), found.end());
  return agree;
}

}  // namespace

bool RunRayContest(const ContestOptions& options, std::vector<Row>& rows) {
  bool agree = true;
  for (const bool on_segments : {false, true}) {
    const char* name = on_segments ? "rays from segments" : "rays from free points";
    for (const int size : options.sizes)
      for (const LengthRule& rule : options.lengths)
        agree = RunCase({name, size, rule}, on_segments, options, rows) && agree;
  }
  return agree;
}

}  // namespace flatlight
