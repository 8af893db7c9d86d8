// SPDX-License-Identifier: Apache-2.0
// How much a path is worth: 1 / (variance x processor time) and 1 / (variance x rays) of path tracing, scene by scene.
//
//   sampling_efficiency [CSV [SCENE]]      the rows go to CSV (default: out/sampling_efficiency.csv) as well; with
//                                          SCENE, only scenes whose name has it in it
//
// z^2 is the mean square of (value - truth) / stated error: above 1, errors are stated too small.
//
// The variance is the mean square of (value - truth) / truth over the points of a scene and over seeds, for one path a
// point: measured at 256 paths and scaled. Truth is exact for direct light, else a long rendering, whose own error is
// taken off. Efficiencies are per second, and per ray: twice as much means the same error in half the time. To compare
// two versions, run both by turns: the variances are the same each time, the times are medians.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/execution/executor.h"
#include "core/execution/thread_pool.h"
#include "core/render/field.h"
#include "core/render/settings.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/named_scenes.h"
#include "tests/bench/random_scenes.h"
#include "tests/support/transport/render.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kPoints = 16;
constexpr std::uint32_t kSamples = 256;
constexpr std::uint32_t kTruthSamples = 1 << 16;
constexpr std::uint32_t kTruthSeed = 1'000'000;
constexpr std::uint32_t kSeeds = 24;

struct Case {
  NamedScene scene;
  bool direct = false;
};

void Measure(const Case& c, BenchTable& table) {
  Settings settings;
  ThreadPool pool(ThreadPool::AvailableProcessors());
  if (c.direct) {
    settings.method = Method::kExact;
    settings.max_bounces = 0;
  } else {
    settings.method = Method::kPathTracing;
    settings.samples = kTruthSamples;
    settings.seed = kTruthSeed;
  }
  const std::shared_ptr<const Field> truth = Render(c.scene.scene, settings, pool).field;
  settings.method = Method::kPathTracing;
  settings.samples = kSamples;
  InlineExecutor executor;
  std::vector<double> seconds;
  double squares = 0, z_squares = 0, values = 0, rays = 0, doubt = 0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    settings.seed = seed;
    const double start = ThreadSeconds();
    const std::shared_ptr<const Field> field = Render(c.scene.scene, settings, executor).field;
    seconds.push_back(ThreadSeconds() - start);
    rays += field->rays;
    for (std::size_t p = 0; p < field->probes.size(); ++p) {
      const ProbeField& a = field->probes[p];
      const ProbeField& b = truth->probes[p];
      double mean = 0;
      for (const double e : b.irradiance) mean += e / static_cast<double>(b.irradiance.size());
      for (std::size_t i = 0; i < a.irradiance.size(); ++i) {
        const double scale = std::max(b.irradiance[i], 0.01 * mean);
        if (!(scale > 0)) continue;
        const double error = (a.irradiance[i] - b.irradiance[i]) / scale;
        const double truth_error = b.standard_error.empty() ? 0 : b.standard_error[i] / scale;
        squares += error * error;
        doubt += truth_error * truth_error;
        const double stated = std::hypot(a.standard_error[i] / scale, truth_error);
        if (stated > 0) z_squares += error * error / (stated * stated);
        ++values;
      }
    }
  }
  const double variance = std::max(squares - doubt, 0.0) / values * kSamples;
  const double paths = kSamples * static_cast<double>(c.scene.scene->traits().probe_points);
  const double time = QuartilesOf(seconds).median / paths;
  const double rays_per_path = rays / kSeeds / paths;
  table.Add({c.scene.name, c.direct ? "direct" : "all", Short(variance), Short(1e9 * time), Short(rays_per_path),
             Short(1 / (variance * time)), Short(1 / (variance * rays_per_path)), Short(z_squares / values)});
}

int Run(const std::string& csv, const std::string& only) {
  std::vector<NamedScene> scenes = GalleryScenes(kPoints);
  scenes.push_back({"row of 4 rooms", RowOfRooms(4, kPoints)});
  scenes.push_back({"half black room", HalfBlackRoom(kPoints)});
  scenes.push_back({"12 lamps", ManyLamps(12, 0.5, kPoints)});
  scenes.push_back({"100 lamps", ManyLamps(100, 0.5, kPoints)});
  scenes.push_back({"10,000 lamps", ManyLamps(10'000, 0.5, kPoints)});
  scenes.push_back({"row of 40 rooms", RowOfRooms(40, kPoints)});
  scenes.push_back({"city of 20 houses", City(20, 0.5, kPoints)});
  scenes.push_back({"50 segments", BuiltRandomSegments(50, 0.5, kPoints)});
  BenchTable table({"scene", "light", "variance", "ns a path", "rays a path", "per second", "per ray", "z^2"});
  for (const NamedScene& scene : scenes) {
    if (scene.name.find(only) == std::string::npos) continue;
    Measure({scene, true}, table);
    if (scene.scene->traits().max_reflectance > 0) Measure({scene, false}, table);
  }
  return table.Report(csv) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  return flatlight::Run(argc > 1 ? argv[1] : "out/sampling_efficiency.csv", argc > 2 ? argv[2] : "");
}
