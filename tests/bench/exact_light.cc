// SPDX-License-Identifier: Apache-2.0
// Exact light at single points on one thread, with both derivatives and all error bounds: items are points.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/plane/bvh.h"
#include "core/plane/exact/exact.h"
#include "core/scene/scene.h"
#include "tests/bench/light_scenes.h"
#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kPoints = 300;

void Evaluate(benchmark::State& state, const SceneDescription& description, int derivatives = 2) {
  const std::shared_ptr<const Scene> scene = Built(description);
  const Bvh bvh(*scene);
  ExactOptions options;
  options.derivatives = derivatives;
  options.channels = 1;
  ExactSolver solver(*scene, bvh, options);
  std::vector<Receiver> receivers;
  for (const Probe& probe : scene->probes())
    receivers.insert(receivers.end(), probe.receivers.begin(), probe.receivers.end());
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solver.Evaluate(receivers[i]));
    if (++i == receivers.size()) i = 0;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["looked at"] = solver.tests() / static_cast<double>(state.iterations());
}

enum class Place { kFloor, kCurves, kFree };

SceneDescription OneProbe(SceneDescription scene, Place place) {
  const ProbeDescription floor = scene.probes.front(), free = scene.probes.back();
  if (place == Place::kFloor) scene.probes = {floor};
  if (place == Place::kFree) scene.probes = {free};
  if (place == Place::kCurves) scene.probes = {scene.probes.begin() + 1, scene.probes.end() - 1};
  return scene;
}

// Segments of length `factor / sqrt(count)`, all of which shine.
void BM_Segments(benchmark::State& state, double factor, Place place) {
  const auto count = static_cast<int>(state.range(0));
  Evaluate(state, OneProbe(ScatteredCurves(count, factor / std::sqrt(count), false, Shining::kAll, kPoints), place));
}

// Of length 0.05, however many there are.
void BM_EqualSegments(benchmark::State& state) {
  Evaluate(state, OneProbe(ScatteredCurves(static_cast<int>(state.range(0)), 0.05, false, Shining::kAll, kPoints),
                           Place::kFree));
}

// One lamp alone shines.
void BM_Lamp(benchmark::State& state, int derivatives) {
  const auto count = static_cast<int>(state.range(0));
  Evaluate(state,
           OneProbe(ScatteredCurves(count, 0.5 / std::sqrt(count), false, Shining::kLamp, kPoints), Place::kFree),
           derivatives);
}

void BM_Arcs(benchmark::State& state) {
  const auto count = static_cast<int>(state.range(0));
  Evaluate(state, OneProbe(ScatteredCurves(count, 0.5 / std::sqrt(count), true, Shining::kAll, kPoints), Place::kFree));
}

void BM_Town(benchmark::State& state) { Evaluate(state, Town(static_cast<int>(state.range(0)), kPoints)); }

void BM_Passage(benchmark::State& state) { Evaluate(state, Passage(static_cast<int>(state.range(0)), kPoints)); }

BENCHMARK_CAPTURE(BM_Segments, half_floor, 0.5, Place::kFloor)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, half_curves, 0.5, Place::kCurves)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, half_free, 0.5, Place::kFree)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, one_free, 1.0, Place::kFree)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, tenth_free, 0.1, Place::kFree)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK(BM_EqualSegments)->RangeMultiplier(10)->Range(100, 10'000);
BENCHMARK_CAPTURE(BM_Lamp, irradiance, 0)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Lamp, hessian, 2)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK(BM_Arcs)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK(BM_Town)->Arg(5)->Arg(16)->Arg(50)->Arg(158);
BENCHMARK(BM_Passage)->Arg(5)->Arg(50)->Arg(500);

}  // namespace
}  // namespace flatlight
