// SPDX-License-Identifier: Apache-2.0
// Whether the errors that irradiance caching expects of itself have the right size, in random scenes.
//
//   caching_calibration [SCENES [CSV]]     default: 12 of each kind, out/caching_calibration.csv
//   caching_calibration --check            few scenes; status 1 if errors are beyond their estimates more than they may
//
// Errors are differences from the reference beyond its own bound. Of all points: at how many the error is above the
// estimate and above twice as much, the largest error over its estimate and in which scene, and at how many points the
// error is above the tolerance that was asked for (relative to irradiance, or to 1 % of its mean).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "core/render/field.h"
#include "core/render/settings.h"
#include "tests/bench/bench_report.h"
#include "tests/support/transport/random_room.h"
#include "tests/support/transport/render.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kDense = 8;          // So many times the points of a test's room.
constexpr double kRounding = 1e-9;           // Relative to irradiance: less is no error.
constexpr double kSecondsOfReference = 2;    // What it is off by then is in its bound.
constexpr double kDoubt = 0.1;               // Of what is allowed: the most that the truth may be unsure by.
constexpr double kDark = 0.01;               // Of the mean: what errors of dark points are relative to.
constexpr std::uint64_t kFirstSeed = 1000;   // Tests of other things have those below.
constexpr std::uint32_t kCheckedScenes = 8;  // Of each kind.

struct Kind {
  const char* name;
  std::shared_ptr<const Scene> (*make)(std::uint64_t seed, std::uint32_t times);
};
constexpr Kind kKinds[] = {{"random room", RandomRoom}, {"hard room", HardRoom}};

// What a check allows: shares of points, and the largest ratio.
// Twice and more what the bench finds in many rooms, so that other roundings pass and a wrong estimate does not.
constexpr double kMostAbove = 0.02, kMostFarAbove = 0.005, kMostDoubtful = 0.02, kWorst = 10;

struct Found {
  double points = 0, records = 0, above = 0, far_above = 0, above_tolerance = 0;
  double doubtful = 0;  // Points of which reference knows too little to tell.
  double worst = 0;     // In units of the estimate.
  std::uint64_t worst_seed = 0;

  void Add(const Field& field, const Field& truth, double tolerance, std::uint64_t seed) {
    records += static_cast<double>(field.records.size());
    for (std::size_t p = 0; p < truth.probes.size(); ++p) {
      const ProbeField &probe = field.probes[p], &right = truth.probes[p];
      const double mean = std::accumulate(right.irradiance.begin(), right.irradiance.end(), 0.0) /
                          static_cast<double>(right.irradiance.size());
      for (std::size_t i = 0; i < right.irradiance.size(); ++i, ++points) {
        const double correct = right.irradiance[i];
        const double allowed = tolerance * std::max(correct, kDark * mean);
        const double off = std::abs(probe.irradiance[i] - correct) - right.irradiance_error[i] - kRounding * correct;
        if (!(off <= allowed)) ++above_tolerance;
        if (!(right.irradiance_error[i] <= kDoubt * allowed)) ++doubtful;
        if (off <= 0) continue;
        const double ratio = off / std::max(probe.estimated_error[i], kRounding * correct);
        if (!(ratio <= 1)) ++above;
        if (!(ratio <= 2)) ++far_above;
        if (!(ratio <= worst)) worst = ratio, worst_seed = seed;
      }
    }
  }
};

// With each tolerance and degree.
struct Way {
  double tolerance;
  std::uint32_t degree;
};

std::vector<Found> Measure(const Kind& kind, std::uint32_t scenes, const std::vector<Way>& ways) {
  std::vector<Found> found(ways.size());
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + scenes; ++seed) {
    const std::shared_ptr<const Scene> scene = kind.make(seed, kDense);
    Settings settings;
    settings.method = Method::kReference;
    settings.derivatives = Derivatives::kNone;
    settings.time_limit = kSecondsOfReference;
    const auto truth = Render(scene, settings).field;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      settings = Settings();
      settings.method = Method::kIrradianceCaching;
      settings.tolerance = ways[i].tolerance;
      settings.extrapolation = ways[i].degree;
      found[i].Add(*Render(scene, settings).field, *truth, ways[i].tolerance, seed);
    }
  }
  return found;
}

int Run(std::uint32_t scenes, const std::string& csv) {
  const std::vector<Way> ways = {{0.03, 1}, {0.03, 2}, {0.01, 1}, {0.01, 2}, {0.001, 1}, {0.001, 2}};
  BenchTable table({"scenes", "tolerance", "degree", "points", "records", "% above estimate", "% above twice", "worst",
                    "its seed", "% above tolerance"});
  for (const Kind& kind : kKinds) {
    const std::vector<Found> found = Measure(kind, scenes, ways);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const Found& f = found[i];
      table.Add({kind.name, Short(ways[i].tolerance), std::to_string(ways[i].degree), Short(f.points), Short(f.records),
                 Short(100 * f.above / f.points), Short(100 * f.far_above / f.points), Short(f.worst),
                 std::to_string(f.worst_seed), Short(100 * f.above_tolerance / f.points)});
    }
  }
  return table.Report(csv) ? 0 : 1;
}

int Check() {
  bool right = true;
  for (const Kind& kind : kKinds) {
    const Found f = Measure(kind, kCheckedScenes, {{0.01, 2}})[0];
    std::printf(
        "%s: above the estimate at %.2f %% of %.0f points, above twice at %.2f %%, at worst %.1f times; the truth is "
        "unsure "
        "at %.2f %%\n",
        kind.name, 100 * f.above / f.points, f.points, 100 * f.far_above / f.points, f.worst,
        100 * f.doubtful / f.points);
    right = right && f.above < kMostAbove * f.points && f.far_above < kMostFarAbove * f.points &&
            f.doubtful < kMostDoubtful * f.points && f.worst < kWorst;
  }
  return right ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--check") return flatlight::Check();
  const int scenes = argc > 1 ? std::atoi(argv[1]) : 12;
  if (scenes < 1 || scenes > 100'000) {
    std::fprintf(stderr, "%s is no number of scenes, 1 to 100000\n", argv[1]);
    return 2;
  }
  return flatlight::Run(static_cast<std::uint32_t>(scenes), argc > 2 ? argv[2] : "out/caching_calibration.csv");
}
