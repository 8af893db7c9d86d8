// SPDX-License-Identifier: Apache-2.0
// From a description to a scene that transport can work on: validation, normalisation, hashes.
#include <benchmark/benchmark.h>

#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"
#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

void BM_BuildScene(benchmark::State& state) {
  const SceneDescription description = RandomSegments(static_cast<int>(state.range(0)), 0.5, 1024);
  for (auto _ : state) {
    Diagnostics diagnostics;
    benchmark::DoNotOptimize(BuildScene(description, diagnostics));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(BM_BuildScene)->Arg(10)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flatlight
