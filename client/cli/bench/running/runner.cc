// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/running/runner.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>
#include <map>
#include <optional>

#include "client/cli/bench/measurement/measurement.h"
#include "client/cli/bench/plan/budgets.h"
#include "client/cli/bench/running/bench_job.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kDefaultTimeLimit = 60;  // s, for the default ladder of budgets.
constexpr double kOverhead = 0.005;       // s a run, besides what the server states.

std::string Now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::string text(32, '\0');
  text.resize(std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc));
  return text;
}

struct BenchPoint {
  std::optional<std::uint32_t> budget;
  double seconds = 0;  // That a run takes, as far as is known; 0: not asked yet.
};

// One method in one scene, climbing its budgets.
struct Ladder {
  const Subject* subject;
  const BenchMethod* method;
  std::vector<BenchPoint> points;
  std::size_t top = 0;  // Points below are run.
  bool warm = false;
  bool AtTop() const { return top == points.size(); }
};

// In proportion to the rays that look them up, as the method's defaults are.
std::uint32_t PhotonsFor(std::uint32_t samples) {
  constexpr std::uint32_t kPhotonsPerSample = 256;
  return std::min(samples, std::numeric_limits<std::uint32_t>::max() / kPhotonsPerSample) * kPhotonsPerSample;
}

class Runner {
 public:
  Runner(Connection& connection, const BenchOptions& options, std::uint32_t base_seed, const BenchRow& context,
         const std::vector<BenchRow>& rows, const RunnerHooks& hooks)
      : connection_(connection),
        options_(options),
        base_seed_(base_seed),
        context_(context),
        hooks_(hooks),
        rounds_(options.seeds * options.repeats),
        limit_(options.time_limit.value_or(options.budgets.empty() ? kDefaultTimeLimit
                                                                   : std::numeric_limits<double>::infinity())),
        rows_(rows) {}

  absl::StatusOr<RunnerReport> Run(const std::vector<Subject>& subjects) {
    MakeLadders(subjects);
    if (absl::Status climbed = Climb(); !climbed.ok()) return climbed;
    for (std::uint32_t round = 1; round < rounds_; ++round)
      if (absl::Status done = DoRound(round); !done.ok()) return done;
    if (late_ > 0)
      report_.left_out.push_back(Plural(late_, "run") + " for which no time was left (--time-limit " +
                                 FormatExactly(limit_) + ")");
    return report_;
  }

 private:
  void MakeLadders(const std::vector<Subject>& subjects) {
    const std::vector<std::uint32_t> budgets = options_.budgets.empty() ? DefaultBudgets() : options_.budgets;
    for (const Subject& subject : subjects)
      for (const BenchMethod& method : subject.methods) {
        Ladder& ladder = ladders_.emplace_back(Ladder{&subject, &method, {}});
        if (!method.takes_samples) ladder.points.emplace_back();
        for (const std::uint32_t budget : method.takes_samples ? budgets : std::vector<std::uint32_t>())
          ladder.points.push_back({budget});
      }
  }

  // The first round. Always the budget whose missing runs take least time, so that curves climb side by side; until it
  // does not fit into the time that those taken on before leave.
  absl::Status Climb() {
    for (;;) {
      Ladder* next = nullptr;
      double least = std::numeric_limits<double>::infinity();
      for (Ladder& ladder : ladders_) {
        if (ladder.AtTop()) continue;
        const auto cost = Cost(ladder, ladder.points[ladder.top]);
        if (!cost.ok()) return cost.status();
        if (next == nullptr || *cost < least) {
          next = &ladder;
          least = *cost;
        }
      }
      if (next == nullptr) return absl::OkStatus();
      if (least > 0 && least > limit_ - Elapsed() - Committed()) break;
      BenchPoint& point = next->points[next->top++];
      const int missing = Missing(*next, point);
      planned_ += missing;
      report_.before += static_cast<int>(rounds_) - missing;
      if (absl::Status done = DoRun(*next, point, 0); !done.ok()) return done;
    }
    return LeaveOut();
  }

  double Elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  // Of the runs that are missing at a point.
  absl::StatusOr<double> Cost(Ladder& ladder, const BenchPoint& point) {
    const int missing = Missing(ladder, point);
    if (missing == 0) return 0;
    const auto seconds = Expected(ladder, ladder.top);
    if (!seconds.ok()) return seconds.status();
    return *seconds * missing;
  }

  // Of the runs to come at points that are taken on.
  double Committed() const {
    double seconds = 0;
    for (const Ladder& ladder : ladders_)
      for (std::size_t i = 0; i < ladder.top; ++i)
        seconds += ladder.points[i].seconds * Missing(ladder, ladder.points[i]);
    return seconds;
  }

  absl::Status LeaveOut() {
    for (Ladder& ladder : ladders_) {
      if (ladder.AtTop()) continue;
      const BenchPoint& point = ladder.points[ladder.top];
      const auto cost = Cost(ladder, point);
      if (!cost.ok()) return cost.status();
      std::string text = ladder.subject->argument.label + " " + ladder.method->name;
      if (point.budget) text += " from " + std::to_string(*point.budget) + " samples on";
      report_.left_out.push_back(text + ": another " + FormatSeconds(*cost) + " (--time-limit " +
                                 FormatExactly(limit_) + ")");
    }
    return absl::OkStatus();
  }

  absl::Status DoRound(std::uint32_t round) {
    std::size_t levels = 0;
    for (const Ladder& ladder : ladders_) levels = std::max(levels, ladder.top);
    for (std::size_t level = 0; level < levels; ++level)
      for (Ladder& ladder : ladders_) {
        if (level >= ladder.top) continue;
        if (absl::Status done = DoRun(ladder, ladder.points[level], round); !done.ok()) return done;
      }
    return absl::OkStatus();
  }

  // Seconds of a run: as measured, or in the file, or in proportion to a smaller budget, or to the run that warms up.
  absl::StatusOr<double> Expected(Ladder& ladder, std::size_t level) {
    BenchPoint& point = ladder.points[level];
    if (point.seconds > 0) return point.seconds;
    const BenchRow run = RowOf(ladder, point, 0);
    const auto same =
        std::find_if(rows_.begin(), rows_.end(), [&run](const BenchRow& row) { return SamePoint(row, run); });
    absl::StatusOr<double> seconds;
    if (same != rows_.end()) {
      seconds = same->wall_seconds + kOverhead;
    } else if (level == 0) {
      seconds = WarmUp(ladder);
    } else {
      seconds = Expected(ladder, level - 1);
      if (seconds.ok()) *seconds *= static_cast<double>(*point.budget) / *ladder.points[level - 1].budget;
    }
    if (seconds.ok()) point.seconds = *seconds;
    return seconds;
  }

  absl::StatusOr<double> WarmUp(Ladder& ladder) {
    ladder.warm = true;
    const BenchPoint& point = ladder.points[0];
    const Clock::time_point start = Clock::now();
    const auto result =
        RunJob(*ladder.subject, SettingsOf(ladder, point, kTruthSeed), ladder.method->name + " warming up");
    if (!result.ok()) return result.status();
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  std::uint32_t SeedNumber(std::uint32_t number) const { return number % options_.seeds; }

  v1::Settings SettingsOf(const Ladder& ladder, const BenchPoint& point, std::uint32_t seed) const {
    v1::Settings settings = ladder.method->settings;
    if (point.budget) settings.set_samples(*point.budget);
    if (point.budget && ladder.method->takes_photons) settings.set_photons(PhotonsFor(*point.budget));
    if (ladder.method->takes_seed) settings.set_seed(seed);
    return settings;
  }

  // What the row of a run says before it has been done.
  BenchRow RowOf(const Ladder& ladder, const BenchPoint& point, std::uint32_t number) const {
    BenchRow row = context_;
    row.scene = ladder.subject->argument.label;
    row.scene_hash = ladder.subject->hash;
    row.method = ladder.method->name;
    row.settings = ladder.method->text;
    row.truth = ladder.subject->truth.name;
    row.threads = ladder.method->threads;
    row.budget = point.budget;
    row.repeat = number;
    if (ladder.method->takes_seed) {
      row.seed = SeedOfRun(base_seed_, point.budget.value_or(0), SeedNumber(number));
      row.repeat = number / options_.seeds;
    }
    return row;
  }

  bool IsDone(const BenchRow& run) const {
    return std::any_of(rows_.begin(), rows_.end(), [&run](const BenchRow& row) { return SameRun(row, run); });
  }

  int Missing(const Ladder& ladder, const BenchPoint& point) const {
    int missing = 0;
    for (std::uint32_t number = 0; number < rounds_; ++number) missing += IsDone(RowOf(ladder, point, number)) ? 0 : 1;
    return missing;
  }

  absl::Status DoRun(Ladder& ladder, BenchPoint& point, std::uint32_t number) {
    BenchRow row = RowOf(ladder, point, number);
    if (IsDone(row)) return absl::OkStatus();
    if (Elapsed() > limit_) {
      ++late_;
      return absl::OkStatus();
    }
    if (!ladder.warm)
      if (auto warm = WarmUp(ladder); !warm.ok()) return warm.status();
    const auto truth = TruthOf(ladder);
    if (!truth.ok()) return truth.status();
    const Clock::time_point start = Clock::now();
    const std::string what = ladder.method->name + (point.budget ? ' ' + std::to_string(*point.budget) : "");
    const auto result = RunJob(*ladder.subject, SettingsOf(ladder, point, row.seed.value_or(0)), what);
    if (!result.ok()) return result.status();
    if (absl::Status measured = Measure(*result, **truth, row); !measured.ok()) return measured;
    point.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    row.date = Now();
    ++report_.done;
    rows_.push_back(row);
    return hooks_.keep(row);
  }

  absl::StatusOr<const v1::RenderResult*> TruthOf(const Ladder& ladder) {
    const Subject& subject = *ladder.subject;
    if (subject.truth.file != nullptr) return subject.truth.file;
    const auto known = truths_.find(&subject);
    if (known != truths_.end()) return &known->second;
    auto result = RunJob(subject, *subject.truth.render, "truth");
    if (!result.ok()) return result.status();
    return &(truths_[&subject] = *std::move(result));
  }

  absl::StatusOr<v1::RenderResult> RunJob(const Subject& subject, const v1::Settings& settings,
                                          const std::string& what) {
    BenchJobHooks hooks;
    hooks.check_server = hooks_.check_server;
    hooks.on_update = [&](const v1::Job& job) {
      std::string line = subject.argument.label + ' ' + what;
      if (planned_ > 0) line = std::to_string(report_.done) + " of " + std::to_string(planned_) + " runs  " + line;
      if (job.progress().fraction() > 0 && job.state() == v1::Job::RUNNING)
        line += "  " + FormatPercent(job.progress().fraction());
      return hooks_.show(line);
    };
    return RunBenchJob(connection_, subject.source, settings, hooks);
  }

  Connection& connection_;
  const BenchOptions& options_;
  const std::uint32_t base_seed_;
  const BenchRow& context_;
  const RunnerHooks& hooks_;
  const std::uint32_t rounds_;
  const double limit_;
  const Clock::time_point start_ = Clock::now();
  std::vector<BenchRow> rows_;  // Of before and of now.
  std::vector<Ladder> ladders_;
  std::map<const Subject*, v1::RenderResult> truths_;
  RunnerReport report_;
  int planned_ = 0;  // Runs that are taken on so far.
  int late_ = 0;     // Runs for which no time was left.
};

}  // namespace

BenchRow RowContext(const Connection& connection, const std::string& client_build, const std::string& server_build) {
  BenchRow row;
  row.processor = connection.capabilities().processor();
  row.processors = connection.capabilities().processors();
  row.client = client_build;
  row.server = server_build;
  return row;
}

absl::StatusOr<RunnerReport> RunBench(Connection& connection, const std::vector<Subject>& subjects,
                                      const BenchOptions& options, std::uint32_t base_seed, const BenchRow& context,
                                      const std::vector<BenchRow>& rows, const RunnerHooks& hooks) {
  return Runner(connection, options, base_seed, context, rows, hooks).Run(subjects);
}

}  // namespace flatlight
