// SPDX-License-Identifier: Apache-2.0
// What a class feels of a server: how soon pictures come and jobs end, what watchers cost.
//
//   serving [CSV]      the rows go to CSV (default: out/serving.csv) as well
//
// A flatlightd with 2 threads on this machine, by the public API alone; callers and server share its processors.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/bench_daemon.h"
#include "tests/bench/bench_report.h"

namespace flatlight {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using Render = v1::RenderService::Stub;

constexpr int kOthers = 200;
constexpr int kPictures = 60;
constexpr int kCallers = 50;
constexpr std::chrono::seconds kCallersTime{20};
constexpr int kCancels = 100;
constexpr int kWatchers = 1000;
constexpr std::chrono::seconds kSilence{60};
constexpr std::chrono::seconds kShareTime{15};

double MillisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

v1::CreateJobRequest SmallJob() {
  return RequestFromJson(
      R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "PATH_TRACING", "samples": 64}, "anew": true})");
}

// Takes hours.
v1::CreateJobRequest LongJob(v1::JobClass job_class) {
  v1::CreateJobRequest request = RequestFromJson(
      R"({"scene": {"name": "scenes/cornell"}, "settings": {"method": "PATH_TRACING", "samples": 100000000}, "anew": true})");
  request.set_job_class(job_class);
  return request;
}

std::string Create(Render& render, const v1::CreateJobRequest& request) {
  CallContext context;
  v1::Job job;
  const grpc::Status created = render.CreateJob(&context, request, &job);
  if (!created.ok()) Die("CreateJob: " + created.error_message());
  return job.name();
}

void Cancel(Render& render, const std::string& job) {
  CallContext context;
  v1::CancelJobRequest request;
  request.set_name(job);
  v1::Job ended;
  if (const grpc::Status status = render.CancelJob(&context, request, &ended); !status.ok()) {
    Die("CancelJob: " + status.error_message());
  }
}

v1::WatchJobRequest WatchOf(const std::string& job) {
  v1::WatchJobRequest request;
  request.set_name(job);
  return request;
}

v1::GetActivityResponse Activity(BenchDaemon& daemon) {
  CallContext context;
  v1::GetActivityResponse activity;
  const grpc::Status status = daemon.server().GetActivity(&context, {}, &activity);
  if (!status.ok()) Die("GetActivity: " + status.error_message());
  return activity;
}

// From before CreateJob until the first values have come, ms. Reads on to the end of the job.
double AwaitFirstPicture(Render& render, const v1::CreateJobRequest& request) {
  const Clock::time_point start = Clock::now();
  const v1::WatchJobRequest watch = WatchOf(Create(render, request));
  CallContext context;
  const auto reader = render.WatchJob(&context, watch);
  double first = 0;
  for (v1::WatchJobResponse update; reader->Read(&update);) {
    if (first == 0 && update.updates_size() > 0) first = MillisecondsSince(start);
  }
  if (const grpc::Status status = reader->Finish(); !status.ok()) Die("WatchJob: " + status.error_message());
  if (first == 0) Die("a job ended without a picture");
  return first;
}

// A row: the distribution of latencies, and the one that has a goal.
void AddLatencies(BenchTable& table, const std::string& what, std::vector<double> ms, double goal_share, double goal) {
  std::sort(ms.begin(), ms.end());
  const auto quantile = [&](double share) {
    return ms[std::min(ms.size() - 1, static_cast<std::size_t>(share * static_cast<double>(ms.size())))];
  };
  const double reached = goal_share == 1 ? ms.back() : quantile(goal_share);
  table.Add({what, Short(static_cast<double>(ms.size())), Short(quantile(0.5)), Short(quantile(0.95)),
             Short(quantile(0.99)), Short(ms.back()), "ms", "p" + Short(100 * goal_share) + " " + Short(goal),
             reached <= goal ? "met" : "MISSED"});
}

void AddValue(BenchTable& table, const std::string& what, double value, const std::string& unit, double goal) {
  table.Add({what, "1", Short(value), "", "", "", unit, Short(goal), value <= goal ? "met" : "MISSED"});
}

void MeasureFirstPictures(const std::string& program, BenchTable& table) {
  for (const auto& [name, job_class] : {std::pair("graded", v1::GRADED), std::pair("regrade", v1::REGRADE)}) {
    const TemporaryFolder folder;
    BenchDaemon daemon(program, folder.path(), {"--data", folder.path() + "/data"});
    for (int i = 0; i < kOthers; ++i) Create(daemon.render(), LongJob(job_class));
    std::vector<double> ms;
    for (int i = 0; i < kPictures; ++i) ms.push_back(AwaitFirstPicture(daemon.render(), SmallJob()));
    AddLatencies(table, "first picture, " + std::to_string(kOthers) + " others (" + name + ")", ms, 1, 100);
  }
}

void MeasureCallers(const std::string& program, BenchTable& table) {
  const TemporaryFolder folder;
  BenchDaemon daemon(program, folder.path(), {"--data", folder.path() + "/data"});
  std::mutex mutex;
  std::vector<double> ms;
  const Clock::time_point end = Clock::now() + kCallersTime;
  std::vector<std::thread> callers;
  for (int caller = 0; caller < kCallers; ++caller) {
    callers.emplace_back([&, caller] {
      std::mt19937 random(static_cast<std::uint32_t>(caller));
      const auto render = v1::RenderService::NewStub(daemon.Connect());
      while (Clock::now() < end) {
        std::this_thread::sleep_for(milliseconds(random() % 2000));
        const double first = AwaitFirstPicture(*render, SmallJob());
        const std::lock_guard lock(mutex);
        ms.push_back(first);
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  AddLatencies(table, "first picture, " + std::to_string(kCallers) + " callers, 1 s apart", ms, 0.95, 250);
}

enum class Way : std::uint8_t { kCall, kDisconnect, kDeadline };

// From the wish to cancel until the server says that nothing works on the job any more, ms.
double AwaitCancel(Render& render, Way way) {
  const std::string job = Create(render, LongJob(v1::INTERACTIVE));
  CallContext staying;
  const auto reader = render.WatchJob(&staying, WatchOf(job));
  v1::WatchJobResponse update;
  while (update.updates_size() == 0) {
    if (!reader->Read(&update)) Die("a watch ended early");
  }
  Clock::time_point start = Clock::now();
  std::unique_ptr<grpc::ClientContext> leaving;
  std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> tied;
  if (way == Way::kCall) {
    Cancel(render, job);
  } else {
    constexpr milliseconds kDeadline{50};
    leaving = std::make_unique<CallContext>(way == Way::kDeadline ? kDeadline : std::chrono::seconds(60));
    v1::WatchJobRequest watch = WatchOf(job);
    watch.set_cancel_on_disconnect(true);
    tied = render.WatchJob(leaving.get(), watch);
    v1::WatchJobResponse first;
    if (!tied->Read(&first)) Die("no update before the deadline");
    if (way == Way::kDeadline) {
      start += kDeadline;
    } else {
      start = Clock::now();
      leaving->TryCancel();
    }
  }
  while (update.job().state() != v1::Job::CANCELLED) {
    if (!reader->Read(&update)) Die("a watch ended without the end of its job");
  }
  const double ms = MillisecondsSince(start);
  if (tied != nullptr) tied->Finish();
  return ms;
}

void MeasureCancels(const std::string& program, BenchTable& table) {
  const TemporaryFolder folder;
  BenchDaemon daemon(program, folder.path(), {"--data", folder.path() + "/data"});
  for (int i = 0; i < 10; ++i) Create(daemon.render(), LongJob(v1::GRADED));
  for (const auto& [name, way] : {std::pair("call", Way::kCall), std::pair("disconnect", Way::kDisconnect),
                                  std::pair("deadline", Way::kDeadline)}) {
    std::vector<double> ms;
    for (int i = 0; i < kCancels; ++i) ms.push_back(AwaitCancel(daemon.render(), way));
    AddLatencies(table, std::string("cancel by ") + name, ms, 0.99, 200);
  }
}

// Watchers with a connection each, which read the first picture of a job that goes on, and then nothing.
void MeasureWatchers(const std::string& program, BenchTable& table) {
  const TemporaryFolder folder;
  BenchDaemon daemon(program, folder.path(), {"--data", folder.path() + "/data"});
  const std::string job = Create(daemon.render(), LongJob(v1::INTERACTIVE));
  struct Watching {
    std::unique_ptr<Render> render;
    CallContext context{std::chrono::seconds(600)};
    std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> reader;
  };
  std::vector<std::unique_ptr<Watching>> watching;
  std::this_thread::sleep_for(std::chrono::seconds(2));
  const double before = Activity(daemon).resident_bytes();
  double message = 0;
  for (int i = 0; i < kWatchers; ++i) {
    auto one = std::make_unique<Watching>();
    one->render = v1::RenderService::NewStub(daemon.Connect());
    one->reader = one->render->WatchJob(&one->context, WatchOf(job));
    v1::WatchJobResponse update;
    do {
      if (!one->reader->Read(&update)) Die("a watch ended early");
      message = std::max(message, static_cast<double>(update.ByteSizeLong()));
    } while (update.updates_size() == 0 || update.more());
    watching.push_back(std::move(one));
  }
  const double reading = Activity(daemon).resident_bytes();
  std::this_thread::sleep_for(kSilence);
  const v1::GetActivityResponse after = Activity(daemon);
  if (after.watches() != kWatchers) Die("only " + Short(after.watches()) + " watches are open");
  AddValue(table, std::to_string(kWatchers) + " watchers, each", (reading - before) / kWatchers / 1024, "KiB", 64);
  AddValue(table, "the same after a minute without reading", (after.resident_bytes() - before) / kWatchers / 1024,
           "KiB", 64 + message / 1024);
  for (const auto& one : watching) one->context.TryCancel();
  for (const auto& one : watching) one->reader->Finish();
}

// Processor time of the server that is not that of jobs, with readers of all that it sends.
void MeasureShare(const std::string& program, BenchTable& table) {
  for (const int watchers : {1, 10}) {
    const TemporaryFolder folder;
    BenchDaemon daemon(program, folder.path(), {"--data", folder.path() + "/data"});
    const std::string job = Create(daemon.render(), LongJob(v1::INTERACTIVE));
    std::vector<std::unique_ptr<CallContext>> contexts;
    std::vector<std::thread> readers;
    for (int i = 0; i < watchers; ++i) {
      contexts.push_back(std::make_unique<CallContext>());
      readers.emplace_back([&, context = contexts.back().get()] {
        const auto reader = daemon.render().WatchJob(context, WatchOf(job));
        for (v1::WatchJobResponse update; reader->Read(&update);) {
        }
        reader->Finish();
      });
    }
    std::this_thread::sleep_for(std::chrono::seconds(2));
    const v1::GetActivityResponse from = Activity(daemon);
    std::this_thread::sleep_for(kShareTime);
    const v1::GetActivityResponse to = Activity(daemon);
    const double jobs = to.job_cpu_seconds() - from.job_cpu_seconds();
    const double rest = to.cpu_seconds() - from.cpu_seconds() - jobs;
    AddValue(table, "serving, of a job's processor time, " + std::to_string(watchers) + " watching", 100 * rest / jobs,
             "%", 3);
    for (const auto& context : contexts) context->TryCancel();
    for (std::thread& reader : readers) reader.join();
  }
}

int Run(const std::string& program, const std::string& csv) {
  BenchTable table({"what", "cases", "median", "p95", "p99", "most", "unit", "goal", ""});
  MeasureFirstPictures(program, table);
  MeasureCallers(program, table);
  MeasureCancels(program, table);
  MeasureWatchers(program, table);
  MeasureShare(program, table);
  return table.Report(csv) ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) {
  return flatlight::Run(flatlight::DaemonBesides(argv[0]), argc > 1 ? argv[1] : "out/serving.csv");
}
