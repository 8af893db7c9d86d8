// SPDX-License-Identifier: Apache-2.0
// Irradiance caching against path tracing and ray tracing at equal time, in the gallery's diffuse scenes.
//
//   irradiance_caching [TOLERANCE [CSV]]      default: 0.01, out/irradiance_caching.csv
//
// One thread, every method from the scene on, indexes and panels included. In each round caching goes first, and the
// others get the processor time that it took, or what their first value at each point takes if that is longer. Errors
// are root mean squares relative to irradiance, or to 1 % of its mean; medians over the rounds. Of caching's own
// estimates: at how many points the error is above it, above twice as much, and the largest error over its estimate.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/execution/executor.h"
#include "core/render/rendering.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/named_scenes.h"
#include "tests/support/transport/render.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kRounds = 5;
constexpr std::size_t kFewestPoints = 100;

struct Run {
  double seconds = 0;
  std::shared_ptr<const Field> field;
};

// Whether every point has a value.
bool IsWhole(const Field& field) {
  return std::all_of(field.probes.begin(), field.probes.end(), [](const ProbeField& probe) {
    return std::all_of(probe.samples.begin(), probe.samples.end(), [](double n) { return n > 0; });
  });
}

// Until done, or for `seconds` and until every point has a value.
Run RunFor(const std::shared_ptr<const Scene>& scene, const Settings& settings, double seconds) {
  double start = ThreadSeconds();
  const std::unique_ptr<Rendering> rendering = StartRendering(scene, PlanFor(*scene, settings));
  InlineExecutor executor;
  const SteadyClock clock;
  const Cancellation never;
  for (;;) {
    while (!rendering->done() && (ThreadSeconds() - start < seconds || rendering->Progress().samples == 0))
      rendering->Advance(executor, never, clock, std::chrono::microseconds(50));
    const double end = ThreadSeconds();
    Run run{end - start, rendering->Snapshot()};
    if (rendering->done() || IsWhole(*run.field)) return run;
    // Looking is not its work.
    start += ThreadSeconds() - end;
    rendering->Advance(executor, never, clock, std::chrono::microseconds(50));
  }
}

double ErrorOf(const Field& field, const Field& truth) {
  double squares = 0, count = 0;
  for (std::size_t p = 0; p < truth.probes.size(); ++p) {
    const std::vector<double>&values = field.probes[p].irradiance, &truths = truth.probes[p].irradiance;
    const double mean = std::accumulate(truths.begin(), truths.end(), 0.0) / static_cast<double>(truths.size());
    for (std::size_t i = 0; i < truths.size(); ++i) {
      const double off = (values[i] - truths[i]) / std::max(truths[i], 0.01 * mean);
      squares += off * off, ++count;
    }
  }
  return std::sqrt(squares / count);
}

// How far errors are beyond what caching expects of itself; what the reference is off by aside.
struct Expectation {
  double above = 0, far_above = 0;  // Shares of the points: beyond the estimate, and beyond twice as much.
  double worst = 0;                 // In units of the estimate.
};

Expectation ExpectationOf(const Field& field, const Field& truth) {
  constexpr double kOfReference = 1e-6;
  Expectation expectation;
  double count = 0;
  for (std::size_t p = 0; p < truth.probes.size(); ++p) {
    const ProbeField& probe = field.probes[p];
    for (std::size_t i = 0; i < probe.irradiance.size(); ++i, ++count) {
      const double correct = truth.probes[p].irradiance[i];
      const double off = std::abs(probe.irradiance[i] - correct), estimate = probe.estimated_error[i];
      expectation.worst = std::max(expectation.worst, off / (estimate + kOfReference * correct));
      if (off > estimate + kOfReference * correct) ++expectation.above;
      if (off > 2 * estimate + kOfReference * correct) ++expectation.far_above;
    }
  }
  expectation.above /= count, expectation.far_above /= count;
  return expectation;
}

double Median(std::vector<double> values) { return QuartilesOf(std::move(values)).median; }

void Measure(const NamedScene& named, double tolerance, BenchTable& table) {
  const auto& scene = named.scene;
  Settings settings;
  settings.method = Method::kReference;
  settings.derivatives = Derivatives::kNone;
  const auto truth = RunFor(scene, settings, 1e9).field;
  std::vector<double> seconds, error;
  std::vector<double> other_seconds[2], other_error[2];
  double records = 0;
  Expectation expectation;
  for (std::uint32_t round = 0; round < kRounds; ++round) {
    settings = Settings();
    settings.method = Method::kIrradianceCaching;
    settings.tolerance = tolerance;
    const Run caching = RunFor(scene, settings, 1e9);
    records = static_cast<double>(caching.field->records.size());
    seconds.push_back(caching.seconds);
    error.push_back(ErrorOf(*caching.field, *truth));
    expectation = ExpectationOf(*caching.field, *truth);
    int which = 0;
    for (const Method method : {Method::kPathTracing, Method::kRayTracing}) {
      settings = Settings();
      settings.method = method;
      settings.derivatives = Derivatives::kNone;
      settings.seed = round;
      settings.time_limit = 1e6;  // No end of samples.
      const Run run = RunFor(scene, settings, caching.seconds);
      other_seconds[which].push_back(run.seconds);
      other_error[which].push_back(ErrorOf(*run.field, *truth));
      ++which;
    }
  }
  std::vector<std::string> row = {named.name, Short(static_cast<double>(scene->traits().probe_points)), Short(records),
                                  Short(1e3 * Median(seconds)), Short(Median(error)),
                                  // Every round has the same values.
                                  Short(100 * expectation.above), Short(100 * expectation.far_above),
                                  Short(expectation.worst)};
  for (int which = 0; which < 2; ++which) {
    row.push_back(Short(Median(other_seconds[which]) / Median(seconds)));
    row.push_back(Short(Median(other_error[which])));
    row.push_back(Short(Median(other_error[which]) / Median(error)));
  }
  table.Add(row);
}

int RunAll(double tolerance, const std::string& csv) {
  BenchTable table({"scene", "points", "records", "ms", "error", "% above estimate", "% above twice", "worst",
                    "path tracing: time", "error", "times as large", "ray tracing: time", "error", "times as large"});
  for (const NamedScene& named : GalleryScenes(1'000'000)) {
    const SceneTraits& traits = named.scene->traits();
    if (traits.lambertian && traits.pixels == 0 && traits.camera_pixels == 0 && traits.probe_points > kFewestPoints)
      Measure(named, tolerance, table);
  }
  return table.Report(csv) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  const double tolerance = argc > 1 ? std::atof(argv[1]) : 0.01;
  if (!(tolerance > 0 && tolerance <= 1)) {
    std::fprintf(stderr, "%s is no tolerance in (0, 1]\n", argv[1]);
    return 2;
  }
  return flatlight::RunAll(tolerance, argc > 2 ? argv[2] : "out/irradiance_caching.csv");
}
