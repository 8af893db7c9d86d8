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
#include "core/plane/triangulation/triangulation.h"
#include "core/scene/scene.h"
#include "tests/bench/light_scenes.h"
#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kPoints = 300;

// `index`: what is looked in for what a point sees.
enum class Index { kTree, kTriangles };

void Evaluate(benchmark::State& state, const SceneDescription& description, Index index = Index::kTree,
              int derivatives = 2) {
  const std::shared_ptr<const Scene> scene = Built(description);
  const Bvh bvh(*scene);
  ExactOptions options;
  options.derivatives = derivatives;
  options.channels = 1;
  const auto triangulation = index == Index::kTriangles ? Triangulation::Of(*scene) : nullptr;
  ExactSolver solver(*scene, bvh, options, triangulation.get());
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
  state.counters["left to the tree"] = solver.undecided() / static_cast<double>(state.iterations());
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
void BM_Segments(benchmark::State& state, double factor, Place place, Index index = Index::kTree) {
  const auto count = static_cast<int>(state.range(0));
  Evaluate(state, OneProbe(ScatteredCurves(count, factor / std::sqrt(count), false, Shining::kAll, kPoints), place),
           index);
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
           Index::kTree, derivatives);
}

void BM_Arcs(benchmark::State& state) {
  const auto count = static_cast<int>(state.range(0));
  Evaluate(state, OneProbe(ScatteredCurves(count, 0.5 / std::sqrt(count), true, Shining::kAll, kPoints), Place::kFree));
}

void BM_Town(benchmark::State& state, Index index) {
  Evaluate(state, Town(static_cast<int>(state.range(0)), kPoints), index);
}

void BM_Passage(benchmark::State& state, Index index) {
  Evaluate(state, Passage(static_cast<int>(state.range(0)), kPoints), index);
}

// Making the triangulation: items are segments.
void BM_Triangulate(benchmark::State& state) {
  const auto count = static_cast<int>(state.range(0));
  const auto scene = Built(ScatteredCurves(count, 0.5 / std::sqrt(count), false, Shining::kLamp, 1));
  std::size_t bytes = 0;
  for (auto _ : state) bytes = Triangulation::Of(*scene)->bytes();
  state.SetItemsProcessed(state.iterations() * count);
  state.counters["bytes each"] = static_cast<double>(bytes) / count;
}

BENCHMARK_CAPTURE(BM_Segments, half_floor, 0.5, Place::kFloor)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, half_curves, 0.5, Place::kCurves)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, half_free, 0.5, Place::kFree)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, one_free, 1.0, Place::kFree)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, tenth_free, 0.1, Place::kFree)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK(BM_EqualSegments)->RangeMultiplier(10)->Range(100, 10'000);
BENCHMARK_CAPTURE(BM_Lamp, irradiance, 0)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Lamp, hessian, 2)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK(BM_Arcs)->RangeMultiplier(10)->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, half_floor_triangles, 0.5, Place::kFloor, Index::kTriangles)
    ->RangeMultiplier(10)
    ->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, half_curves_triangles, 0.5, Place::kCurves, Index::kTriangles)
    ->RangeMultiplier(10)
    ->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Segments, half_free_triangles, 0.5, Place::kFree, Index::kTriangles)
    ->RangeMultiplier(10)
    ->Range(100, 100'000);
BENCHMARK_CAPTURE(BM_Town, tree, Index::kTree)->Arg(5)->Arg(16)->Arg(50)->Arg(158);
BENCHMARK_CAPTURE(BM_Town, triangles, Index::kTriangles)->Arg(5)->Arg(16)->Arg(50)->Arg(158);
BENCHMARK_CAPTURE(BM_Passage, tree, Index::kTree)->Arg(5)->Arg(50)->Arg(500);
BENCHMARK_CAPTURE(BM_Passage, triangles, Index::kTriangles)->Arg(5)->Arg(50)->Arg(500);
BENCHMARK(BM_Triangulate)->RangeMultiplier(10)->Range(100, 100'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flatlight
