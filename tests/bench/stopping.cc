// SPDX-License-Identifier: Apache-2.0
// Whether errors tell the truth where sampling stops by itself, and what stopping costs.
//
//   stopping [CSV]      the rows go to CSV (default: out/stopping.csv) as well
//
// For each scene and target error: many seeds, each compared with a long rendering of the same points. z is
// (value - truth) / error, the error being the stated one and the truth's own in quadrature: honest errors give a mean
// of 0 and a mean square of 1.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/render/field.h"
#include "core/render/settings.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/named_scenes.h"
#include "tests/bench/random_scenes.h"
#include "tests/support/transport/render.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kPoints = 12;
constexpr std::uint32_t kTruthSamples = 1 << 16;
constexpr std::uint32_t kTruthSeed = 1'000'000;

struct Case {
  NamedScene scene;
  double target;
  std::uint32_t runs;
};

void Measure(const Case& c, BenchTable& table) {
  Settings settings;
  settings.method = Method::kPathTracing;
  settings.samples = kTruthSamples;
  settings.seed = kTruthSeed;
  const std::shared_ptr<const Field> truth = Render(c.scene.scene, settings, ThreadPool::AvailableProcessors()).field;
  settings.samples.reset();
  settings.target_error = c.target;
  double values = 0, z_sum = 0, z_squares = 0, z_fourth = 0, largest = 0, samples = 0, points = 0, bias = 0, most = 0;
  double error_squares = 0;
  for (std::uint32_t seed = 0; seed < c.runs; ++seed) {
    settings.seed = seed;
    const std::shared_ptr<const Field> field = Render(c.scene.scene, settings, ThreadPool::AvailableProcessors()).field;
    for (std::size_t p = 0; p < field->probes.size(); ++p) {
      const ProbeField& a = field->probes[p];
      const ProbeField& b = truth->probes[p];
      for (const double n : a.samples) samples += n, ++points, most = std::max(most, n);
      for (std::size_t i = 0; i < a.irradiance.size(); ++i) {
        const double error = std::hypot(a.standard_error[i], b.standard_error[i]);
        if (error == 0 || b.irradiance[i] == 0) continue;
        const double difference = a.irradiance[i] - b.irradiance[i];
        const double z = difference / error;
        ++values, z_sum += z, z_squares += z * z, z_fourth += z * z * z * z;
        largest = std::max(largest, std::abs(z));
        bias += difference / b.irradiance[i];
        error_squares += difference * difference / (b.irradiance[i] * b.irradiance[i]);
      }
    }
  }
  const double mean_square = z_squares / values;
  const double noise = std::sqrt((z_fourth / values - mean_square * mean_square) / values);
  table.Add({c.scene.name, Short(c.target), Short(values), Short(samples / points), Short(most), Short(z_sum / values),
             Short(mean_square), Short(noise), Short(largest), Short(100 * bias / values),
             Short(std::sqrt(error_squares / values)), Short(samples / points * error_squares / values)});
}

int Run(const std::string& csv) {
  std::vector<Case> cases;
  for (const NamedScene& scene : GalleryScenes(kPoints)) {
    if (scene.name == "keyhole") {
      cases.push_back({scene, 0.3, 80});
      cases.push_back({scene, 0.1, 60});
      cases.push_back({scene, 0.05, 12});
    }
    if (scene.name == "cornell") cases.push_back({scene, 0.1, 60});
    if (scene.name == "penumbra") {
      cases.push_back({scene, 0.1, 150});
      cases.push_back({scene, 0.02, 60});
    }
    if (scene.name == "ring" || scene.name == "corner" || scene.name == "furnace") cases.push_back({scene, 0.05, 80});
  }
  cases.push_back({{"row of 4 rooms", RowOfRooms(4, kPoints)}, 0.05, 60});
  cases.push_back({{"row of 4 rooms", RowOfRooms(4, kPoints)}, 0.2, 100});
  cases.push_back({{"half black room", HalfBlackRoom(kPoints)}, 0.05, 80});
  cases.push_back({{"100 lamps", ManyLamps(100, 0.5, kPoints)}, 0.1, 40});
  cases.push_back({{"city of 20 houses", City(20, 0.5, kPoints)}, 0.1, 20});
  BenchTable table({"scene", "target", "values", "samples", "most", "mean z", "mean z^2", "+-", "largest z", "bias %",
                    "rms error", "samples x error^2"});
  for (const Case& c : cases) Measure(c, table);
  return table.Report(csv) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) { return flatlight::Run(argc > 1 ? argv[1] : "out/stopping.csv"); }
