// SPDX-License-Identifier: Apache-2.0
// Numerical stress: random scenes by the hundred thousand, every check on each; failing scenes are minimised and saved.
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <mutex>
#include <string>
#include <thread>

#include "CLI/CLI.hpp"
#include "core/scene/diagnostic.h"
#include "flatlight/v1/scene.pb.h"
#include "server/convert/describe_scene.h"
#include "server/convert/scene_reader.h"
#include "tests/bench/stress/campaign.h"
#include "tests/bench/stress/known_limits.h"
#include "tests/bench/stress/physics.h"
#include "tests/bench/stress/scene_json.h"

namespace flatlight::stress {
namespace {

using Time = std::chrono::steady_clock;

std::string FileName(std::string name) {
  for (char& c : name)
    if (c == ' ') c = '-';
  return name;
}

void Save(const std::filesystem::path& folder, const std::string& name, const SceneDescription& scene) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / (name + ".json")) << SceneJson(scene);
}

void Report(const FoundFailure& found, std::uint64_t seed, const std::filesystem::path& folder) {
  const std::string name =
      FileName(found.check + "-" + found.family + "-" + std::to_string(seed) + "-" + std::to_string(found.number));
  Save(folder, name, found.minimised);
  std::printf("FAILED %s on scene %llu of %s: %s\n       minimised, %s/%s.json (--replay-seed %llu): %s\n",
              found.check.c_str(), static_cast<unsigned long long>(found.number), found.family.c_str(),
              found.what.c_str(), folder.c_str(), name.c_str(), static_cast<unsigned long long>(found.check_seed),
              found.what_minimised.c_str());
  std::fflush(stdout);
}

// Ends the program, with the scene saved, if one check takes too long.
class Watchdog {
 public:
  Watchdog(double seconds, std::filesystem::path folder)
      : seconds_(seconds), folder_(std::move(folder)), thread_([this] { Watch(); }) {}
  ~Watchdog() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  void Start(const SceneDescription& scene, const Check& check) {
    const std::lock_guard lock(mutex_);
    scene_ = &scene;
    check_ = &check;
    begin_ = Time::now();
  }
  // While scenes are changed or minimised, or nothing runs.
  void Pause() {
    const std::lock_guard lock(mutex_);
    scene_ = nullptr;
  }

 private:
  void Watch() {
    std::unique_lock lock(mutex_);
    while (!done_) {
      changed_.wait_for(lock, std::chrono::milliseconds(200));
      if (scene_ == nullptr || std::chrono::duration<double>(Time::now() - begin_).count() < seconds_) continue;
      Save(folder_, FileName("hang-" + check_->name), *scene_);
      std::printf("HANG   %s on a scene of %s: no end after %g s; saved\n", check_->name.c_str(), scene_->name.c_str(),
                  seconds_);
      std::fflush(stdout);
      _exit(1);
    }
  }

  const double seconds_;
  const std::filesystem::path folder_;
  std::mutex mutex_;
  std::condition_variable changed_;
  const SceneDescription* scene_ = nullptr;  // Guarded by mutex_, as are those below.
  const Check* check_ = nullptr;
  Time::time_point begin_;
  bool done_ = false;
  std::thread thread_;
};

int Replay(const std::string& path, std::uint64_t seed) {
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  v1::Scene proto;
  Diagnostics diagnostics;
  if (!ReadSceneJson(text, proto, diagnostics)) {
    std::fprintf(stderr, "stress: %s: %s\n", path.c_str(), diagnostics.kept()[0].message.c_str());
    return 2;
  }
  const SceneDescription scene = DescribeScene(proto, diagnostics);
  int failures = 0;
  Tally tally;
  for (const Check& check : Checks()) {
    const Failure failure = check.run(scene, seed, tally);
    std::printf("%-16s %s\n", check.name.c_str(), failure ? failure->c_str() : "passed");
    failures += failure ? 1 : 0;
  }
  return failures == 0 ? 0 : 1;
}

// Calls visit(kind, quantity, pool, whether it is news).
template <typename Visit>
void EachPooled(const Tally& tally, const Visit& visit) {
  for (const auto& [what, pool] : tally.biases) visit("bias", what, pool, pool.IsAbove() || pool.IsBelow());
  for (const auto& [what, pool] : tally.excesses) visit("excess of errors", what, pool, pool.IsAbove());
}

void WriteCsv(const std::filesystem::path& folder, const CampaignResult& result) {
  std::filesystem::create_directories(folder);
  std::ofstream lines(folder / "checks.csv");
  lines << "family,check,scenes,failures,seconds\n";
  for (const auto& [key, line] : result.lines) {
    lines << key.first << ',' << key.second << ',' << line.scenes << ',' << line.failures << ',' << line.seconds
          << '\n';
  }
  std::ofstream pooled(folder / "pooled.csv");
  pooled << "kind,quantity,scenes,sum,squares,score\n" << std::setprecision(17);
  EachPooled(result.tally, [&](const char* kind, const std::string& what, const Pooled& pool, bool) {
    pooled << kind << ',' << what << ',' << pool.scenes() << ',' << pool.sum() << ',' << pool.squares() << ','
           << pool.Score() << '\n';
  });
  std::ofstream ratios(folder / "ratios.csv");
  ratios << "quantity,values,median,share_99,share_99_99,largest\n";
  for (const auto& [what, ratio] : result.tally.ratios) {
    ratios << what << ',' << ratio.count() << ',' << ratio.Quantile(0.5) << ',' << ratio.Quantile(0.99) << ','
           << ratio.Quantile(0.9999) << ',' << ratio.largest() << '\n';
  }
}

void PrintSummary(const CampaignResult& result, double seconds) {
  std::map<std::string, CampaignLine> by_check;
  for (const auto& [key, line] : result.lines) {
    CampaignLine& sum = by_check[key.second];
    sum.scenes += line.scenes, sum.failures += line.failures, sum.seconds += line.seconds;
  }
  std::printf("\n%-18s %10s %10s %10s\n", "CHECK", "SCENES", "FAILURES", "SECONDS");
  for (const auto& [name, line] : by_check) {
    std::printf("%-18s %10llu %10llu %10.1f\n", name.c_str(), static_cast<unsigned long long>(line.scenes),
                static_cast<unsigned long long>(line.failures), line.seconds);
  }
  std::printf("\n%-40s %10s %9s %9s %9s %9s\n", "|DIFFERENCE| / BOUND", "VALUES", "MEDIAN", "99 %", "99.99 %",
              "LARGEST");
  for (const auto& [what, ratio] : result.tally.ratios) {
    std::printf("%-40s %10llu %9.2g %9.2g %9.2g %9.3g\n", what.c_str(), static_cast<unsigned long long>(ratio.count()),
                ratio.Quantile(0.5), ratio.Quantile(0.99), ratio.Quantile(0.9999), ratio.largest());
  }
  for (const auto& [what, z] : result.tally.deviations) {
    std::printf("\nz of %s: %.0f values, mean %.4f (+- %.4f if honest), mean square %.3f, largest %.2f\n", what.c_str(),
                z.count, z.Mean(), 1 / std::sqrt(z.count), z.MeanSquare(), z.largest);
  }
  std::printf("\n%-17s %-28s %10s %9s\n", "POOLED", "QUANTITY", "SCENES", "SCORE");
  EachPooled(result.tally, [](const char* kind, const std::string& what, const Pooled& pool, bool) {
    std::printf("%-17s %-28s %10.0f %9.2f\n", kind, what.c_str(), pool.scenes(), pool.Score());
  });
  std::printf("\n");
  for (const auto& [what, count] : result.tally.counts) {
    std::printf("%-40s %12llu\n", what.c_str(), static_cast<unsigned long long>(count));
  }
  std::printf("\n%llu scenes in %.1f s, %llu failures\n", static_cast<unsigned long long>(result.scenes), seconds,
              static_cast<unsigned long long>(result.failures));
}

int Main(int argc, char** argv) {
  CLI::App app{"Random scenes by the hundred thousand, and what must be true of every one."};
  CampaignOptions options;
  double time_bound = 60, hang_bound = 60;
  std::string folder = "out/stress", replay;
  std::uint64_t replay_seed = 1;
  bool skip_physics = false;
  options.scenes = 1'000'000'000;
  app.add_option("--seed", options.seed, "another campaign")->capture_default_str();
  app.add_option("--first", options.first, "number of the first scene of each family")->capture_default_str();
  app.add_option("--scenes", options.scenes, "scenes of each family, at most")->capture_default_str();
  app.add_option("--seconds", time_bound, "when to stop")->capture_default_str();
  app.add_option("--family", options.families, "only this family; may repeat");
  app.add_option("--check", options.checks, "only this check; may repeat");
  app.add_option("--minimise", options.most_minimised, "failures of each check and family to minimise and save")
      ->capture_default_str();
  app.add_option("--hang", hang_bound, "seconds that one check may take")->capture_default_str();
  app.add_option("--out", folder, "folder for failing scenes and CSV")->capture_default_str();
  app.add_flag("--no-physics", skip_physics, "leave out the scenes with a known law");
  app.add_option("--replay", replay, "run all checks on one scene file instead");
  app.add_option("--replay-seed", replay_seed, "the seed of those checks")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (!replay.empty()) return Replay(replay, replay_seed);

  const auto begin = Time::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Time::now() - begin).count(); };
  bool failed = false;
  if (!skip_physics && options.checks.empty() && options.families.empty()) {
    for (const PhysicsCheck& check : PhysicsChecks()) {
      const Failure failure = check.run(options.seed);
      std::printf("%-40s %s\n", check.name.c_str(), failure ? failure->c_str() : "passed");
      std::fflush(stdout);
      failed = failed || failure.has_value();
    }
  }
  CampaignResult result;
  {
    Watchdog watchdog(hang_bound, folder);
    CampaignListener listener;
    listener.go_on = [&] {
      watchdog.Pause();
      return elapsed() < time_bound;
    };
    listener.starting = [&](const SceneDescription& scene, const Check& check) { watchdog.Start(scene, check); };
    listener.found = [&](const FoundFailure& found) { Report(found, options.seed, folder); };
    result = RunCampaign(options, listener);
  }
  WriteCsv(folder, result);
  PrintSummary(result, elapsed());
  bool news = failed;
  for (const auto& [key, line] : result.lines) {
    if (line.failures == 0) continue;
    const bool known =
        IsKnown(key.first, key.second, static_cast<double>(line.failures), static_cast<double>(line.scenes));
    std::printf("%-8s %s on %s: %llu of %llu scenes\n", known ? "known" : "NEWS", key.second.c_str(), key.first.c_str(),
                static_cast<unsigned long long>(line.failures), static_cast<unsigned long long>(line.scenes));
    news = news || !known;
  }
  EachPooled(result.tally, [&](const char* kind, const std::string& what, const Pooled& pool, bool is_news) {
    if (!is_news) return;
    std::printf("NEWS     %s of %s: a score of %.2f over %.0f scenes\n", kind, what.c_str(), pool.Score(),
                pool.scenes());
    news = true;
  });
  return news ? 1 : 0;
}

}  // namespace
}  // namespace flatlight::stress

int main(int argc, char** argv) { return flatlight::stress::Main(argc, argv); }
