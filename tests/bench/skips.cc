// SPDX-License-Identifier: Apache-2.0
// What each skip saves, wherever it applies, and whether it changes the result; and what planning costs.
//
//   skips [CSV]      the rows go to CSV (default: out/skips.csv) as well, those on planning to
//                    skips-planning.csv beside
//
// A skip is measured on every scene and setting that takes it: rendered with it and without, turn by turn, on one
// thread, in processor time. Exit status 1 if any result changed by a bit, or if a skip applied to nothing.
//
// Of all cases of a skip the geometric mean is given, with an interval of 95 % (Student's t, on logarithms). A case in
// which every turn was faster, or slower, tells more than its median: where nothing is saved, chance alone makes 1 in
// 512 of either.
#include "core/render/skips.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/render/plan.h"
#include "core/render/rendering.h"
#include "tests/bench/bench_report.h"
#include "tests/bench/named_scenes.h"
#include "tests/bench/random_scenes.h"
#include "tests/support/transport/render.h"

namespace flatlight {
namespace {

constexpr int kTurns = 9;
constexpr int kPlanTurns = 25;
constexpr std::uint32_t kPoints = 48;
// A rendering is repeated until it takes this long, so that timing errs little.
constexpr double kLeastSeconds = 4e-3;

struct Rendered {
  std::shared_ptr<const Field> field;
  double seconds = 0;
};

Rendered RenderTimes(const std::shared_ptr<const Scene>& scene, const Plan& plan, int times) {
  InlineExecutor executor;
  const Cancellation never;
  const SteadyClock clock;
  Rendered rendered;
  const double start = ThreadSeconds();
  for (int i = 0; i < times; ++i) {
    const std::unique_ptr<Rendering> rendering = StartRendering(scene, plan);
    while (!rendering->done()) rendering->Advance(executor, never, clock, std::chrono::hours(1));
    rendered.field = rendering->Snapshot();
  }
  rendered.seconds = (ThreadSeconds() - start) / times;
  return rendered;
}

bool SameBits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

bool SameBits(const Field& a, const Field& b) {
  if (a.probes.size() != b.probes.size()) return false;
  for (std::size_t p = 0; p < a.probes.size(); ++p) {
    for (const auto array :
         {&ProbeField::irradiance, &ProbeField::standard_error, &ProbeField::gradient, &ProbeField::gradient_error,
          &ProbeField::hessian, &ProbeField::hessian_error, &ProbeField::samples}) {
      if (!SameBits(a.probes[p].*array, b.probes[p].*array)) return false;
    }
  }
  return true;
}

struct NamedSettings {
  std::string name;
  Settings settings;
};

std::vector<NamedSettings> AllSettings() {
  Settings exact;
  exact.method = Method::kExact;
  exact.max_bounces = 0;
  Settings values = exact;
  values.derivatives = Derivatives::kNone;
  Settings paths;
  paths.method = Method::kPathTracing;
  paths.samples = 128;
  Settings direct = paths;
  direct.max_bounces = 0;
  Settings target = paths;
  target.samples = 1024;
  target.target_error = 0.05;
  return {{"exact, Hessian", exact},
          {"exact, values", values},
          {"paths", paths},
          {"paths, direct light", direct},
          {"paths to 5 %", target}};
}

// What is known of one skip over all scenes.
struct Summary {
  std::vector<double> ratios;  // Medians.
  std::size_t always_faster = 0;
  std::size_t always_slower = 0;
  bool same = true;
};

// Of positive numbers, and an interval of 95 %.
struct GeometricMean {
  double from = 0;
  double mean = 0;
  double to = 0;
};

GeometricMean GeometricMeanOf(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += std::log(value);
  const double mean = sum / n;
  for (const double value : values) squares += (std::log(value) - mean) * (std::log(value) - mean);
  if (values.size() < 2) return {0, std::exp(mean), std::numeric_limits<double>::infinity()};
  const boost::math::students_t student(n - 1);
  const double half = boost::math::quantile(student, 0.975) * std::sqrt(squares / (n - 1) / n);
  return {std::exp(mean - half), std::exp(mean), std::exp(mean + half)};
}

class SkipBench {
 public:
  SkipBench()
      : table_({"skip", "scene", "settings", "ms with", "ms without", "q1", "times faster", "q3", "rays with",
                "rays without", "result"}) {}

  void Measure(const NamedScene& scene, const NamedSettings& settings, const std::string& skip) {
    Settings all = settings.settings;
    all.no_skip = {skip};
    const Plan with = PlanFor(*scene.scene, settings.settings);
    const Plan without = PlanFor(*scene.scene, all);
    const Rendered first = RenderTimes(scene.scene, with, 1);
    const int times = std::max(1, static_cast<int>(kLeastSeconds / std::max(first.seconds, 1e-6)));
    std::vector<double> ratios, seconds_with, seconds_without;
    Rendered a, b;
    for (int turn = 0; turn < kTurns; ++turn) {
      a = RenderTimes(scene.scene, with, times);
      b = RenderTimes(scene.scene, without, times);
      seconds_with.push_back(a.seconds);
      seconds_without.push_back(b.seconds);
      ratios.push_back(b.seconds / a.seconds);
    }
    const bool same = SameBits(*a.field, *b.field) && SameBits(*first.field, *a.field);
    const Quartiles ratio = QuartilesOf(ratios);
    table_.Add({skip, scene.name, settings.name, Short(1e3 * QuartilesOf(seconds_with).median),
                Short(1e3 * QuartilesOf(seconds_without).median), Short(ratio.lower), Short(ratio.median),
                Short(ratio.upper), Short(a.field->rays), Short(b.field->rays), same ? "same bits" : "CHANGED"});
    Summary& summary = summaries_[skip];
    summary.ratios.push_back(ratio.median);
    summary.always_faster += std::all_of(ratios.begin(), ratios.end(), [](double r) { return r > 1; }) ? 1 : 0;
    summary.always_slower += std::all_of(ratios.begin(), ratios.end(), [](double r) { return r < 1; }) ? 1 : 0;
    summary.same = summary.same && same;
  }

  // False if something is wrong.
  bool Report(const std::string& csv) {
    table_.Print();
    std::printf("\n");
    BenchTable totals(
        {"skip", "cases", "always faster", "always slower", "least", "median", "most", "mean", "from", "to", "result"});
    bool good = table_.WriteCsv(csv);
    if (!good) std::fprintf(stderr, "%s could not be written\n", csv.c_str());
    for (const std::string& skip : SkipNames()) {
      const auto found = summaries_.find(skip);
      if (found == summaries_.end()) {
        totals.Add({skip, "0", "", "", "", "", "", "", "", "", "APPLIES TO NOTHING"});
        good = false;
        continue;
      }
      std::vector<double> ratios = found->second.ratios;
      std::sort(ratios.begin(), ratios.end());
      const GeometricMean mean = GeometricMeanOf(ratios);
      totals.Add({skip, std::to_string(ratios.size()), std::to_string(found->second.always_faster),
                  std::to_string(found->second.always_slower), Short(ratios.front()), Short(QuartilesOf(ratios).median),
                  Short(ratios.back()), Short(mean.mean), Short(mean.from), Short(mean.to),
                  found->second.same ? "same bits" : "CHANGED"});
      good = good && found->second.same;
    }
    totals.Print();
    return good;
  }

 private:
  BenchTable table_;
  std::map<std::string, Summary> summaries_;
};

// 200 curves of each kind, and more of everything that might make planning slow.
std::vector<NamedScene> ScenesToPlan() {
  std::vector<NamedScene> scenes;
  scenes.push_back({"200 segments", BuiltRandomSegments(200, 0.5, 256)});
  SceneDescription arcs = RandomSegments(2, 0.5, 256);
  RandomNumbers random(3);
  for (int i = 0; i < 196; ++i) {
    const Point2 center{random.Next(), 0.1 + 0.8 * random.Next()};
    arcs.curves.push_back({"arc " + std::to_string(i), ArcDescription{center, 0.01, 0, 2 * std::numbers::pi}, "grey",
                           i % 100 == 0 ? std::optional(EmissionDescription{{1}, true}) : std::nullopt});
  }
  scenes.push_back({"200 curves, most of them circles", Built(arcs)});
  scenes.push_back({"200 curves in convex position", ConvexRoom(200, 0.5, 256)});
  SceneDescription lamps = RandomSegments(198, 0.5, 256);
  for (int i = 2; i < 17; ++i) lamps.curves[static_cast<std::size_t>(i)].emission = EmissionDescription{{1}, true};
  scenes.push_back({"200 segments, 16 emit", Built(lamps)});
  scenes.push_back({"200 lamps", ManyLamps(160, 0.5, 256)});
  scenes.push_back({"200 segments, 100,000 points on a curve", BuiltRandomSegments(198, 0.5, 100'000)});
  SceneDescription free = RandomSegments(198, 0.5, 1);
  free.probes.clear();
  ProbeDescription cloud;
  cloud.name = "cloud";
  for (int i = 0; i < 100'000; ++i) cloud.points.push_back({{random.Next(), random.Next()}, {0, 1}});
  free.probes.push_back(cloud);
  scenes.push_back({"200 segments, 100,000 free points", Built(free)});
  SceneDescription room = free;
  room.curves.resize(2);
  scenes.push_back({"two facing walls, 100,000 free points", Built(room)});
  scenes.push_back({"10,000 segments", BuiltRandomSegments(10'000, 0.5, 256)});
  scenes.push_back({"10,000 lamps", ManyLamps(10'000, 0.5, 256)});
  scenes.push_back({"10,000 curves in convex position", ConvexRoom(10'000, 0.5, 256)});
  return scenes;
}

bool MeasurePlanning(const std::string& csv) {
  BenchTable table({"scene", "method", "q1", "ms to plan", "q3"});
  for (const NamedScene& scene : ScenesToPlan()) {
    for (const NamedSettings& settings : {AllSettings()[0], AllSettings()[2], AllSettings()[3]}) {
      std::vector<double> milliseconds;
      for (int turn = 0; turn < kPlanTurns; ++turn) {
        const double start = ThreadSeconds();
        PlanFor(*scene.scene, settings.settings);
        milliseconds.push_back(1e3 * (ThreadSeconds() - start));
      }
      const Quartiles quartiles = QuartilesOf(milliseconds);
      table.Add({scene.name, settings.name, Short(quartiles.lower), Short(quartiles.median), Short(quartiles.upper)});
    }
  }
  return table.Report(csv);
}

// "out/skips.csv": "out/skips-planning.csv".
std::string PlanningCsv(const std::string& csv) {
  const std::filesystem::path path = csv;
  return path.parent_path() / (path.stem().string() + "-planning" + path.extension().string());
}

int Run(const std::string& csv) {
  std::vector<NamedScene> scenes = GalleryScenes(kPoints);
  scenes.push_back({"convex room", ConvexRoom(24, 0.7, kPoints)});
  scenes.push_back({"turned lamps", TurnedLamps(kPoints)});
  scenes.push_back({"no lamp", NoLamp(kPoints)});
  scenes.push_back({"half black room", HalfBlackRoom(kPoints)});
  scenes.push_back({"300 lamps", ManyLamps(300, 0.5, kPoints)});
  scenes.push_back({"row of 4 rooms", RowOfRooms(4, kPoints)});
  scenes.push_back({"city of 20 houses", City(20, 0.5, kPoints)});
  scenes.push_back({"1000 segments", BuiltRandomSegments(1000, 0.5, kPoints)});
  SkipBench bench;
  for (const NamedScene& scene : scenes) {
    for (const NamedSettings& settings : AllSettings()) {
      const Plan plan = PlanFor(*scene.scene, settings.settings);
      for (const SkipEntry& entry : plan.skips) {
        // In the dark nothing is left that another skip could save.
        if (plan.Takes(skip::kEmission) && entry.name != skip::kEmission) continue;
        if (entry.decision == SkipDecision::kTaken) bench.Measure(scene, settings, entry.name);
      }
    }
  }
  const bool good = bench.Report(csv);
  std::printf("\n");
  return MeasurePlanning(PlanningCsv(csv)) && good ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) { return flatlight::Run(argc > 1 ? argv[1] : "out/skips.csv"); }
