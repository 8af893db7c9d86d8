// SPDX-License-Identifier: Apache-2.0
// Rays a second against the number of segments: closest hit, and visibility between two points.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"
#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

constexpr std::size_t kRays = 4096;  // Enough that branch prediction does not learn them.

// Points between the segments, and directions, in the scene's own coordinates.
struct Rays {
  std::vector<SurfacePoint> from;
  std::vector<Vector2> direction;
};

Rays RandomRays(const Frame& frame) {
  RandomNumbers random(2);
  Rays rays;
  for (std::size_t i = 0; i < kRays; ++i) {
    const double angle = 2 * std::numbers::pi * random.Next();
    const Point2 world{random.Next(), random.Next()};
    const Vector2 place = (world - frame.origin) / frame.scale;
    rays.from.push_back({{place.x, place.y}, ElementId::kNone});
    rays.direction.push_back({std::cos(angle), std::sin(angle)});
  }
  return rays;
}

void BM_ClosestHit(benchmark::State& state) {
  const RayCaster caster(BuiltRandomSegments(static_cast<int>(state.range(0)), 0.5, 1));
  const Rays rays = RandomRays(caster.scene().frame());
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(caster.ClosestHit(rays.from[i % kRays], rays.direction[i % kRays]));
    ++i;
  }
  state.SetItemsProcessed(state.iterations());
}

void BM_Visible(benchmark::State& state) {
  const RayCaster caster(BuiltRandomSegments(static_cast<int>(state.range(0)), 0.5, 1));
  const Rays rays = RandomRays(caster.scene().frame());
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(caster.Visible(rays.from[i % kRays], rays.from[(i + 1) % kRays]));
    ++i;
  }
  state.SetItemsProcessed(state.iterations());
}

void BM_BuildRayCaster(benchmark::State& state) {
  const std::shared_ptr<const Scene> scene = BuiltRandomSegments(static_cast<int>(state.range(0)), 0.5, 1);
  for (auto _ : state) benchmark::DoNotOptimize(RayCaster(scene));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(BM_ClosestHit)->Arg(10)->Arg(1000)->Arg(100'000)->Arg(1'000'000);
BENCHMARK(BM_Visible)->Arg(10)->Arg(1000)->Arg(100'000)->Arg(1'000'000);
BENCHMARK(BM_BuildRayCaster)->Arg(10)->Arg(1000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flatlight
