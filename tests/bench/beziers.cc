// SPDX-License-Identifier: Apache-2.0
// Rays and exact light among Bézier curves (argument 0), and among polylines that are as near to the same curves as the
// arcs are that follow them (argument 1): items are rays, or points.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/math/bezier.h"
#include "core/math/tolerances.h"
#include "core/plane/bvh.h"
#include "core/plane/exact/exact.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"
#include "tests/bench/random_scenes.h"

namespace flatlight {
namespace {

// Chords that are nowhere farther than `tolerance` from the curve, to first order.
PolylineDescription Polyline(const BezierDescription& from, double tolerance) {
  const Bezier bezier{{from.p0, from.p1, from.p2, from.p3}};
  PolylineDescription polyline{{from.p0}, false};
  for (double u = 0; u < 1;) {
    // A chord's distance is |P''| step^2 / 8.
    const Vector2 tangent = bezier.Tangent(u, 1);
    const double step = std::sqrt(8 * tolerance / std::max(std::abs(Cross(tangent, bezier.Second(u))), 0.1));
    u = std::min(1.0, u + step);
    polyline.points.push_back(bezier.At(u));
  }
  return polyline;
}

// A floor, and ten curves above it that shine on both sides.
SceneDescription Curves(bool polylines) {
  RandomNumbers random(7);
  SceneDescription scene;
  scene.materials.push_back({"grey", LambertianDescription{{0.5}}});
  scene.curves.push_back({"floor", SegmentDescription{{0, 0}, {1, 0}}, "grey", std::nullopt});
  for (int i = 0; i < 10; ++i) {
    const Point2 place{0.2 + 0.6 * random.Next(), 0.2 + 0.6 * random.Next()};
    const auto point = [&] {
      const double x = random.Next(), y = random.Next();
      return place + 0.4 * Vector2{x - 0.5, y - 0.5};
    };
    const Point2 p0 = point(), p1 = point(), p2 = point(), p3 = point();
    const BezierDescription bezier{p0, p1, p2, p3};
    CurveDescription curve{"c" + std::to_string(i), bezier, "grey", EmissionDescription{{1.0 + i}, true}};
    if (polylines) curve.shape = Polyline(bezier, kBezierShare * Bezier{{p0, p1, p2, p3}}.Extent());
    scene.curves.push_back(std::move(curve));
  }
  ProbeDescription probe;
  probe.name = "floor", probe.curve = "floor", probe.count = 200;
  scene.probes.push_back(probe);
  return scene;
}

void BM_ClosestHit(benchmark::State& state) {
  const RayCaster caster(Built(Curves(state.range(0) == 1)));
  const Frame& frame = caster.scene().frame();
  RandomNumbers random(2);
  constexpr std::size_t kRays = 4096;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < kRays; ++i) {
    const double x = random.Next(), y = random.Next(), angle = 2 * std::numbers::pi * random.Next();
    const Vector2 place = (Point2{x, y} - frame.origin) / frame.scale;
    rays.push_back({{Point2{} + place, ElementId::kNone}, {std::cos(angle), std::sin(angle)}});
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const Ray& ray = rays[i++ % kRays];
    benchmark::DoNotOptimize(caster.ClosestHit(ray.from, ray.direction));
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["pieces"] = static_cast<double>(caster.scene().elements().size());
}

void BM_ExactLight(benchmark::State& state) {
  const std::shared_ptr<const Scene> scene = Built(Curves(state.range(0) == 1));
  const Bvh bvh(*scene);
  ExactSolver solver(*scene, bvh, {.derivatives = 2, .channels = 1});
  const std::vector<Receiver>& receivers = scene->probes()[0].receivers;
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(solver.Evaluate(receivers[i++ % receivers.size()]));
  state.SetItemsProcessed(state.iterations());
}

void BM_Build(benchmark::State& state) {
  const SceneDescription scene = Curves(state.range(0) == 1);
  for (auto _ : state) benchmark::DoNotOptimize(Built(scene));
}

BENCHMARK(BM_ClosestHit)->Arg(0)->Arg(1);
BENCHMARK(BM_ExactLight)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_Build)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace flatlight
