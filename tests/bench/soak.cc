// SPDX-License-Identifier: Apache-2.0
// Whether a server's memory stays flat under the mixed work of a class.
//
//   soak [SECONDS [CSV]]      default: 600 s, the samples go to out/soak.csv
//
// A flatlightd with a folder; callers who submit, watch, leave, cancel, fetch and delete, each with at most kKept jobs.
// What is in memory while they work depends on which jobs are under way; so they do it in rounds, and between two of
// them delete what they have and rest. What the server has allocated then, round for round, is what tells of a leak;
// what it has of the system (resident) also goes by how the C library happens to place things. Through the rounds but
// the first third (caches fill) goes a line over the number of jobs, with its interval of 95 % confidence:
//   flat       the interval ends below kLeak: whatever leaks, leaks less than that
//   LEAKS      it begins above 0, and does not end below kLeak
//   NOT KNOWN  neither: more jobs are needed
// The program fails unless the server is flat, and if resident memory grew by more than kMostGrowth of itself for sure.
// It says how small a leak this run would have found (as LEAKS, in 95 of 100 such runs).
#include <algorithm>
#include <atomic>
#include <boost/math/distributions/students_t.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/bench_daemon.h"
#include "tests/bench/bench_report.h"

namespace flatlight {
namespace {

using Clock = std::chrono::steady_clock;
using Render = v1::RenderService::Stub;

constexpr int kCallers = 8;
constexpr std::size_t kKept = 10;
constexpr double kLeak = 4;  // KiB a job.
constexpr double kMostGrowth = 0.05;
constexpr int kRounds = 15;
constexpr std::chrono::seconds kRest{12};  // Every 5 s a server gives back what it does not need; all, if it rested.

std::vector<v1::CreateJobRequest> Requests() {
  std::vector<v1::CreateJobRequest> requests;
  for (
      const char* json : {
          R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "PATH_TRACING", "samples": 256, "seed": 0}})",
          R"({"scene": {"name": "scenes/lens"}, "settings": {"method": "PATH_TRACING", "samples": 64, "seed": 0}})",
          R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "RAY_TRACING", "samples": 64, "seed": 0}})",
          R"({"scene": {"name": "scenes/penumbra"}, "settings": {"method": "EXACT", "maxBounces": 0}})",
          R"({"scene": {"name": "scenes/penumbra"}, "settings": {"method": "REFERENCE"}})",
          R"({"scene": {"name": "scenes/penumbra"}, "settings": {"method": "IRRADIANCE_CACHING", "seed": 0}})",
          R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "PHOTON_MAPPING", "photons": 20000, "seed": 0}})",
      }) {
    requests.push_back(RequestFromJson(json));
  }
  return requests;
}

struct Counts {
  std::atomic<long> jobs = 0, refused = 0, failed = 0;
};

class Caller {
 public:
  Caller(BenchDaemon& daemon, const std::vector<v1::CreateJobRequest>& requests, std::uint32_t seed, Counts& counts)
      : render_(v1::RenderService::NewStub(daemon.Connect())), requests_(requests), random_(seed), counts_(counts) {}

  void Work(Clock::time_point end) {
    while (Clock::now() < end) {
      if (!Submit()) continue;
      const auto chance = random_() % 10;
      if (chance < 2) {
        Leave();
      } else if (chance < 3) {
        Cancel();
      } else {
        Watch();
        Fetch();
      }
      while (jobs_.size() > kKept) Delete();
    }
    while (!jobs_.empty()) Delete();
  }

 private:
  void Expect(const grpc::Status& status) {
    if (!status.ok()) ++counts_.failed;
  }

  bool Submit() {
    CallContext context;
    v1::CreateJobRequest request = requests_[random_() % requests_.size()];
    request.set_anew(random_() % 2 == 0);
    if (request.settings().has_seed()) request.mutable_settings()->set_seed(static_cast<std::uint32_t>(random_()));
    v1::Job job;
    if (!render_->CreateJob(&context, request, &job).ok()) {
      ++counts_.refused;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      return false;
    }
    ++counts_.jobs;
    jobs_.push_back(job.name());
    return true;
  }

  // Reads one message and goes.
  void Leave() {
    CallContext context;
    v1::WatchJobRequest request;
    request.set_name(jobs_.back());
    request.set_cancel_on_disconnect(random_() % 2 == 0);
    const auto reader = render_->WatchJob(&context, request);
    v1::WatchJobResponse update;
    reader->Read(&update);
    context.TryCancel();
    reader->Finish();
  }

  void Watch() {
    CallContext context;
    v1::WatchJobRequest request;
    request.set_name(jobs_.back());
    const auto reader = render_->WatchJob(&context, request);
    for (v1::WatchJobResponse update; reader->Read(&update);) {
    }
    Expect(reader->Finish());
  }

  void Cancel() {
    CallContext context;
    v1::CancelJobRequest request;
    request.set_name(jobs_.back());
    v1::Job job;
    Expect(render_->CancelJob(&context, request, &job));
  }

  void Fetch() {
    CallContext context;
    v1::GetResultRequest request;
    request.set_name(jobs_.back());
    const auto reader = render_->GetResult(&context, request);
    for (v1::GetResultResponse chunk; reader->Read(&chunk);) {
    }
    Expect(reader->Finish());
  }

  void Delete() {
    CallContext context;
    v1::DeleteJobRequest request;
    request.set_name(jobs_.front());
    v1::DeleteJobResponse deleted;
    Expect(render_->DeleteJob(&context, request, &deleted));
    jobs_.pop_front();
  }

  const std::unique_ptr<Render> render_;
  const std::vector<v1::CreateJobRequest>& requests_;
  std::mt19937 random_;
  Counts& counts_;
  std::deque<std::string> jobs_;
};

struct Line {
  double mean = 0, slope = 0;
  double error = 0;    // Of the slope: half of the interval of 95 % confidence.
  double visible = 0;  // A slope that is found to be above 0 in 95 of 100 cases.

  double lower() const { return slope - error; }
  double upper() const { return slope + error; }
};

Line Fit(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, rest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mean_x += x[i] / n, mean_y += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = xy / xx;
  for (std::size_t i = 0; i < x.size(); ++i) rest += std::pow(y[i] - mean_y - slope * (x[i] - mean_x), 2);
  const boost::math::students_t t(n - 2);
  const double standard_error = std::sqrt(rest / (n - 2) / xx);
  const double two_sided = boost::math::quantile(t, 0.975);
  return {mean_y, slope, two_sided * standard_error, (two_sided + boost::math::quantile(t, 0.95)) * standard_error};
}

v1::GetActivityResponse Activity(BenchDaemon& daemon) {
  CallContext context;
  v1::GetActivityResponse activity;
  if (!daemon.server().GetActivity(&context, {}, &activity).ok()) Die("GetActivity failed");
  return activity;
}

// What the server holds in memory, second for second.
class Samples {
 public:
  explicit Samples(BenchDaemon& daemon) : daemon_(daemon) {}

  void Take(const char* when, long jobs) {
    const v1::GetActivityResponse now = Activity(daemon_);
    resident_ = now.resident_bytes() / (1 << 20);
    heap_ = now.heap_bytes() / (1 << 20);
    const double at = std::chrono::duration<double>(Clock::now() - start_).count();
    table_.Add({Short(at), when, std::to_string(resident_), std::to_string(heap_), std::to_string(jobs)});
  }
  // The newest, MiB.
  double resident() const { return resident_; }
  double heap() const { return heap_; }
  bool Write(const std::string& csv) const { return table_.WriteCsv(csv); }

 private:
  BenchDaemon& daemon_;
  const Clock::time_point start_ = Clock::now();
  double resident_ = 0, heap_ = 0;
  BenchTable table_{{"seconds", "callers", "resident MiB", "heap MiB", "jobs"}};
};

int Run(const std::string& program, double seconds, const std::string& csv) {
  const TemporaryFolder folder;
  BenchDaemon daemon(program, folder.path(), {"--data", folder.path() + "/data"});
  const std::vector<v1::CreateJobRequest> requests = Requests();
  Counts counts;
  std::vector<std::unique_ptr<Caller>> callers;
  for (std::uint32_t seed = 0; seed < kCallers; ++seed) {
    callers.push_back(std::make_unique<Caller>(daemon, requests, seed, counts));
  }
  Samples samples(daemon);
  std::vector<double> busy, resident, heap, done;  // `done`: jobs, by round.
  const auto work_time = std::chrono::milliseconds(static_cast<long>(1000 * seconds / kRounds)) - kRest;
  for (int round = 1; round <= kRounds; ++round) {
    const Clock::time_point end = Clock::now() + work_time;
    std::vector<std::thread> working;
    for (const auto& caller : callers) working.emplace_back([&] { caller->Work(end); });
    while (Clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::seconds(1));
      samples.Take("work", counts.jobs);
      busy.push_back(samples.resident());
    }
    for (std::thread& thread : working) thread.join();
    while (Activity(daemon).users_size() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::this_thread::sleep_for(kRest);
    samples.Take("rest", counts.jobs);
    if (round <= kRounds / 3) continue;
    resident.push_back(samples.resident());
    heap.push_back(samples.heap());
    done.push_back(static_cast<double>(counts.jobs));
  }
  const Line in_use = Fit(done, heap), held = Fit(done, resident);
  const double span = done.back() - done.front();
  const char* const verdict = 1024 * in_use.upper() < kLeak ? "flat" : in_use.lower() > 0 ? "LEAKS" : "NOT KNOWN";
  const bool held_grows = span * held.lower() > kMostGrowth * held.mean;
  const Quartiles quartiles = QuartilesOf(busy);
  std::printf("%ld jobs, %ld refused, %ld calls failed\n", counts.jobs.load(), counts.refused.load(),
              counts.failed.load());
  std::printf("allocated at rest: %.2f MiB; in the last %.0f jobs it grew by %.3f +- %.3f KiB a job (95 %%): %s\n",
              in_use.mean, span, 1024 * in_use.slope, 1024 * in_use.error, verdict);
  std::printf("a leak of %.2f KiB a job would have been found; to reach: less than %.0f KiB\n", 1024 * in_use.visible,
              kLeak);
  std::printf("resident: at work %.0f MiB (median; most: %.0f), at rest %.1f, growth %.2f +- %.2f MiB: %s\n",
              quartiles.median, *std::max_element(busy.begin(), busy.end()), held.mean, span * held.slope,
              span * held.error, held_grows ? "GROWS" : "may be flat");
  const bool flat = std::string(verdict) == "flat" && !held_grows;
  return samples.Write(csv) && flat && counts.failed == 0 && counts.jobs > 0 ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 600;
  if (!(seconds >= 300)) flatlight::Die("soak SECONDS: at least 300");
  return flatlight::Run(flatlight::DaemonBesides(argv[0]), seconds, argc > 2 ? argv[2] : "out/soak.csv");
}
