// SPDX-License-Identifier: Apache-2.0
// From text to a message, and from a description to a scene that transport can work on: strict reading; validation,
// normalisation, hashes.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"
#include "flatlight/v1/scene.pb.h"
#include "server/convert/scene_reader.h"
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

std::string SceneFile(int curves) {
  std::string text =
      R"({"name":"rows","plane":{"materials":[{"name":"grey","lambertian":{"reflectance":[0.5]}}],"curves":[)";
  for (int i = 0; i < curves; ++i) {
    const std::string y = std::to_string(0.001 * i);
    if (i > 0) text += ',';
    text += R"({"name":"row )" + std::to_string(i) + R"(","segment":{"a":{"x":0,"y":)" + y + R"(},"b":{"x":1,"y":)" +
            y + R"(}},"material":"grey"})";
  }
  return text + "]}}";
}

void BM_ReadSceneJson(benchmark::State& state) {
  const std::string text = SceneFile(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    v1::Scene scene;
    Diagnostics diagnostics;
    if (!ReadSceneJson(text, scene, diagnostics)) state.SkipWithError("the scene file has mistakes");
    benchmark::DoNotOptimize(scene);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.size()));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(BM_ReadSceneJson)->Arg(10)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_BuildScene)->Arg(10)->Arg(1000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flatlight
