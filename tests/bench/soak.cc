// SPDX-License-Identifier: Apache-2.0
// Whether a server's memory stays flat under the mixed work of a class.
//
//   soak [SECONDS [CSV]]      default: 600 s, the samples go to out/soak.csv
//
// A flatlightd with a folder; callers who submit, watch, leave, cancel, fetch and delete, each with at most kKept jobs.
// A line through the memory of the later two thirds tells how fast it grows; the program fails if that is more than
// kMostGrowth of the memory in an hour, beyond twice the line's own uncertainty.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
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
constexpr double kMostGrowth = 0.1;

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
  double mean = 0, slope = 0, error = 0;  // Of the slope: one standard error.
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
  return {mean_y, slope, std::sqrt(rest / (n - 2) / xx)};
}

int Run(const std::string& program, double seconds, const std::string& csv) {
  const TemporaryFolder folder;
  BenchDaemon daemon(program, folder.path(), {"--data", folder.path() + "/data"});
  const std::vector<v1::CreateJobRequest> requests = Requests();
  Counts counts;
  const Clock::time_point start = Clock::now();
  const Clock::time_point end = start + std::chrono::milliseconds(static_cast<long>(1000 * seconds));
  std::vector<std::thread> callers;
  for (std::uint32_t seed = 0; seed < kCallers; ++seed) {
    callers.emplace_back([&, seed] { Caller(daemon, requests, seed, counts).Work(end); });
  }
  BenchTable table({"seconds", "MiB", "jobs"});
  std::vector<double> hours, bytes;
  const auto pause = std::chrono::duration<double>(seconds / 120);
  while (Clock::now() < end) {
    std::this_thread::sleep_for(pause);
    CallContext context;
    v1::GetActivityResponse activity;
    if (!daemon.server().GetActivity(&context, {}, &activity).ok()) Die("GetActivity failed");
    const double at = std::chrono::duration<double>(Clock::now() - start).count();
    table.Add({Short(at), Short(activity.resident_bytes() / (1 << 20)), std::to_string(counts.jobs)});
    if (at < seconds / 3) continue;
    hours.push_back(at / 3600);
    bytes.push_back(activity.resident_bytes());
  }
  for (std::thread& caller : callers) caller.join();
  const Line line = Fit(hours, bytes);
  const double growth = line.slope / line.mean, uncertainty = line.error / line.mean;
  const bool flat = growth - 2 * uncertainty <= kMostGrowth;
  std::printf("%ld jobs, %ld refused, %ld calls failed; %.0f MiB, growing by %.1f +- %.1f %% an hour: %s\n",
              counts.jobs.load(), counts.refused.load(), counts.failed.load(), line.mean / (1 << 20), 100 * growth,
              100 * uncertainty, flat ? "flat" : "NOT FLAT");
  return table.WriteCsv(csv) && flat && counts.failed == 0 && counts.jobs > 0 ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 600;
  if (!(seconds >= 12)) flatlight::Die("soak SECONDS: at least 12");
  return flatlight::Run(flatlight::DaemonBesides(argv[0]), seconds, argc > 2 ? argv[2] : "out/soak.csv");
}
