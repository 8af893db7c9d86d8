// SPDX-License-Identifier: Apache-2.0
// Whole renderings on one thread: exact points a second, and path-tracing samples a second.
#include "core/render/rendering.h"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/render/plan.h"
#include "core/render/settings.h"
#include "core/scene/scene.h"
#include "tests/bench/random_scenes.h"
#include "tests/support/transport/render.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kPoints = 64;

void Render(benchmark::State& state, const std::shared_ptr<const Scene>& scene, const Settings& settings,
            double items) {
  const Plan plan = PlanFor(*scene, settings);
  InlineExecutor executor;
  const Cancellation cancellation;
  const SteadyClock clock;
  double rays = 0;
  for (auto _ : state) {
    const std::unique_ptr<Rendering> rendering = StartRendering(scene, plan);
    while (!rendering->done()) rendering->Advance(executor, cancellation, clock, std::chrono::seconds(1));
    rays += rendering->Progress().rays;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(items * static_cast<double>(state.iterations())));
  state.counters["rays"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
}

// Items are points.
void BM_Exact(benchmark::State& state, Derivatives derivatives) {
  Settings settings;
  settings.method = Method::kExact;
  settings.derivatives = derivatives;
  settings.max_bounces = 0;
  Render(state, BuiltRandomSegments(static_cast<int>(state.range(0)), 0.5, kPoints), settings, kPoints);
}

// Items are paths, of as many bounces as roulette grants.
void BM_PathTracing(benchmark::State& state) {
  Settings settings;
  settings.method = Method::kPathTracing;
  settings.samples = 256;
  Render(state, BuiltRandomSegments(static_cast<int>(state.range(0)), 0.5, kPoints), settings, 256.0 * kPoints);
}

BENCHMARK_CAPTURE(BM_Exact, irradiance, Derivatives::kNone)->Arg(10)->Arg(1000)->Arg(100'000);
BENCHMARK_CAPTURE(BM_Exact, hessian, Derivatives::kHessian)->Arg(10)->Arg(1000)->Arg(100'000);
BENCHMARK(BM_PathTracing)->Arg(10)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flatlight
