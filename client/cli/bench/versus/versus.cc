// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/versus/versus.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

struct Pair {
  Runs a, b;
  BenchQuantity quantity;
  PointSamples samples;
};

// The runs of one machine and build, and why others are left out.
Runs OfOneContext(const std::vector<BenchRow>& rows, const std::string& file, std::vector<std::string>& notes) {
  Runs runs;
  std::string other;
  for (const BenchRow& row : rows) {
    const std::string difference = OtherContext(row, rows.back());
    if (difference.empty()) {
      runs.push_back(&row);
    } else {
      other = difference;
    }
  }
  if (!other.empty())
    notes.push_back(Plural(static_cast<double>(rows.size() - runs.size()), "row") + " of " + file +
                    " left out: of another machine or build than the last one (" + other + ")");
  return runs;
}

std::vector<Runs> PointsOf(const Runs& rows) {
  std::vector<Runs> points;
  for (const BenchRow* row : rows) {
    const auto point =
        std::find_if(points.begin(), points.end(), [row](const Runs& runs) { return SamePoint(*runs[0], *row); });
    (point == points.end() ? points.emplace_back() : *point).push_back(row);
  }
  return points;
}

// Why a point of the one file has none in the other.
std::string WhyAlone(const BenchRow& row, const Runs& others) {
  std::string reason = "no such scene";
  for (const BenchRow* other : others) {
    if (other->scene_hash != row.scene_hash) {
      if (other->scene == row.scene) return "the scene is another one (sceneHash)";
      continue;
    }
    if (other->method != row.method) {
      if (reason == "no such scene") reason = "no such method";
    } else if (other->settings != row.settings) {
      reason = "other settings (" + other->settings + ", not " + row.settings + ")";
    } else if (other->truth != row.truth) {
      reason = "another truth (" + other->truth + ", not " + row.truth + ")";
    } else {
      return "no such budget";
    }
  }
  return reason;
}

void NoteAlone(const std::vector<Runs>& points, const std::vector<Runs>& others, const Runs& other_rows,
               const std::string& file, const std::string& other_file, std::vector<std::string>& notes) {
  std::map<std::string, int> reasons;
  for (const Runs& point : points) {
    const bool joined =
        std::any_of(others.begin(), others.end(), [&](const Runs& other) { return SamePoint(*other[0], *point[0]); });
    if (joined) continue;
    ++reasons[point[0]->scene + ' ' + point[0]->method + ": " + WhyAlone(*point[0], other_rows) + " in " + other_file];
  }
  for (const auto& [reason, count] : reasons)
    notes.push_back(Plural(count, "point") + " of " + file + " not compared: " + reason);
}

void SortByCurve(std::vector<Runs>& points) {
  std::stable_sort(points.begin(), points.end(), [](const Runs& a, const Runs& b) {
    return std::tie(a[0]->scene, a[0]->method, a[0]->budget) < std::tie(b[0]->scene, b[0]->method, b[0]->budget);
  });
}

std::vector<Pair> Joined(const std::vector<Runs>& a, const std::vector<Runs>& b, bool times) {
  std::vector<Pair> pairs;
  for (const Runs& runs : a)
    for (const Runs& other : b) {
      if (!SamePoint(*runs[0], *other[0])) continue;
      for (const BenchQuantity quantity : kBenchQuantities) {
        Pair pair{runs, other, quantity, SamplesOf(runs, other, quantity, times)};
        const bool irradiance = quantity == BenchQuantity::kIrradiance;
        if (irradiance || pair.samples.error) pairs.push_back(std::move(pair));
      }
    }
  return pairs;
}

// Tests that chance can fail. Of derivatives the time is that of irradiance, and not judged again.
int TestsOf(const Pair& pair) {
  const int time = pair.samples.time && pair.quantity == BenchQuantity::kIrradiance ? 1 : 0;
  const int error = pair.samples.error && pair.samples.error->by_chance ? 1 : 0;
  return time + error + (pair.samples.Efficiency() ? 1 : 0);
}

std::optional<Ratio> JudgeRatio(const std::optional<Estimate>& ratio, Good good, const RatioRule& rule) {
  if (!ratio) return std::nullopt;
  return Judge(*ratio, good, rule);
}

PointVersus JudgePair(const Pair& pair, const RatioRule& rule) {
  PointVersus point;
  point.scene = pair.a[0]->scene;
  point.method = pair.a[0]->method;
  point.budget = pair.a[0]->budget;
  point.quantity = pair.quantity;
  point.runs_a = static_cast<int>(pair.a.size());
  point.runs_b = static_cast<int>(pair.b.size());
  if (pair.quantity == BenchQuantity::kIrradiance) point.time = JudgeRatio(pair.samples.TimeRatio(), Good::kLess, rule);
  point.error = JudgeRatio(pair.samples.ErrorRatio(), Good::kLess, rule);
  point.efficiency = JudgeRatio(pair.samples.Efficiency(), Good::kMore, rule);
  point.verdict = Together(point.time, point.error, point.efficiency);
  if (point.verdict == Change::kTooNoisy)
    for (const auto& samples : {pair.samples.time, pair.samples.error})
      if (samples && samples->by_chance)
        if (const auto needed = RunsNeeded(*samples, rule))
          point.runs_needed = std::max(point.runs_needed.value_or(0), *needed);
  return point;
}

// Means over the points, value by value: those of one number come from runs near in time, whose disturbances are alike.
std::vector<double> MeansOverPoints(const std::vector<const std::vector<double>*>& samples) {
  std::size_t size = samples.front()->size();
  for (const std::vector<double>* values : samples) size = std::min(size, values->size());
  std::vector<double> means(size);
  for (const std::vector<double>* values : samples)
    for (std::size_t i = 0; i < size; ++i) means[i] += (*values)[i] / static_cast<double>(samples.size());
  return means;
}

// Of all points that depend on chance together.
std::optional<LogSamples> Overall(const std::vector<Pair>& pairs, std::optional<LogSamples> PointSamples::*samples) {
  std::vector<const std::vector<double>*> a, b;
  bool in_pairs = true;
  for (const Pair& pair : pairs) {
    const std::optional<LogSamples>& values = pair.samples.*samples;
    if (pair.quantity != BenchQuantity::kIrradiance || !values || !values->by_chance) continue;
    a.push_back(&values->a);
    b.push_back(&values->b);
    in_pairs = in_pairs && values->pairs;
  }
  if (a.empty()) return std::nullopt;
  return LogSamples{MeansOverPoints(a), MeansOverPoints(b), true, 1, in_pairs};
}

}  // namespace

int Versus::Count(Change verdict) const {
  return static_cast<int>(std::count_if(points.begin(), points.end(),
                                        [verdict](const PointVersus& point) { return point.verdict == verdict; }));
}

bool Versus::SomethingIsWorse() const { return Count(Change::kWorse) > 0 || overall.verdict == Change::kWorse; }

absl::StatusOr<Versus> CompareBenches(const std::vector<BenchRow>& a, const std::vector<BenchRow>& b,
                                      const VersusOptions& options) {
  if (a.empty() || b.empty()) return UsageError(std::string(a.empty() ? "A" : "B") + " has no rows");
  Versus versus;
  const Runs rows_a = OfOneContext(a, "A", versus.notes), rows_b = OfOneContext(b, "B", versus.notes);
  const std::string machine_a = MachineOf(a.back()), machine_b = MachineOf(b.back());
  const bool one_machine = machine_a == machine_b;
  if (!one_machine)
    versus.notes.push_back("different machines, so that only errors are compared, not times: A " + machine_a + "; B " +
                           machine_b);
  std::vector<Runs> points_a = PointsOf(rows_a);
  SortByCurve(points_a);
  const std::vector<Runs> points_b = PointsOf(rows_b);
  NoteAlone(points_a, points_b, rows_b, "A", "B", versus.notes);
  NoteAlone(points_b, points_a, rows_a, "B", "A", versus.notes);
  const std::vector<Pair> pairs = Joined(points_a, points_b, one_machine);
  if (pairs.empty()) {
    std::string reasons;
    for (const std::string& note : versus.notes) reasons += '\n' + note;
    return UsageError("the benchmarks have no point in common" + reasons);
  }
  int tests = 3;  // Overall.
  for (const Pair& pair : pairs) tests += TestsOf(pair);
  const RatioRule rule{options.failure_rate / tests, options.least};
  for (const Pair& pair : pairs) versus.points.push_back(JudgePair(pair, rule));
  versus.overall.runs_a = static_cast<int>(rows_a.size());
  versus.overall.runs_b = static_cast<int>(rows_b.size());
  const PointSamples all = {Overall(pairs, &PointSamples::time), Overall(pairs, &PointSamples::error)};
  versus.overall.time = JudgeRatio(all.TimeRatio(), Good::kLess, rule);
  versus.overall.error = JudgeRatio(all.ErrorRatio(), Good::kLess, rule);
  versus.overall.efficiency = JudgeRatio(all.Efficiency(), Good::kMore, rule);
  versus.overall.verdict = Together(versus.overall.time, versus.overall.error, versus.overall.efficiency);
  return versus;
}

}  // namespace flatlight
