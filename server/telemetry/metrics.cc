// SPDX-License-Identifier: Apache-2.0
#include "server/telemetry/metrics.h"

#include <array>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "prometheus/counter.h"
#include "prometheus/exposer.h"
#include "prometheus/histogram.h"
#include "prometheus/registry.h"
#include "prometheus/text_serializer.h"
#include "server/store/error.h"
#include "server/telemetry/process_readings.h"

namespace flatlight {
namespace {

using prometheus::ClientMetric;
using prometheus::Labels;
using prometheus::MetricFamily;
using prometheus::MetricType;

// s.
const prometheus::Histogram::BucketBoundaries kWaits = {0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1,
                                                        2.5,   5,    10,    30,   60,  300,  1800};
const prometheus::Histogram::BucketBoundaries kCalls = {0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01,
                                                        0.025,  0.05,    0.1,    0.25,  1,      5};

constexpr std::size_t kCodes = 17;  // Of gRPC: 0 to 16.

double Seconds(Clock::Duration duration) { return std::chrono::duration<double>(duration).count(); }

const char* NameOf(JobClass job_class) {
  constexpr std::array<const char*, kJobClasses> kNames = {"interactive", "graded", "regrade"};
  return kNames[static_cast<std::size_t>(job_class)];
}

const char* NameOf(JobPhase phase) {
  return phase == JobPhase::kSucceeded ? "succeeded" : phase == JobPhase::kFailed ? "failed" : "cancelled";
}

MetricFamily OneValue(const char* name, const char* help, MetricType type, double value) {
  ClientMetric metric;
  (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
  return {name, help, type, {metric}};
}

ClientMetric Labelled(const char* label, const char* value, double number) {
  ClientMetric metric;
  metric.label.push_back({label, value});
  metric.gauge.value = metric.counter.value = number;
  return metric;
}

// What is read at each look.
class Looks final : public prometheus::Collectable {
 public:
  void ReadWith(std::function<Readings()> read) {
    const std::lock_guard lock(mutex_);
    read_ = std::move(read);
  }

  Readings Read() const {
    const std::lock_guard lock(mutex_);
    return read_ ? read_() : Readings{};
  }

  std::vector<MetricFamily> Collect() const override {
    std::vector<MetricFamily> families;
    const ProcessReadings process = ReadProcess();
    families.push_back(OneValue("process_cpu_seconds_total", "Processor time of the server.", MetricType::Counter,
                                process.cpu_seconds));
    families.push_back(OneValue("process_resident_memory_bytes", "Resident memory of the server.", MetricType::Gauge,
                                process.resident_bytes));
    families.push_back(OneValue("flatlight_heap_bytes", "Memory that is allocated and in use.", MetricType::Gauge,
                                process.heap_bytes));
    families.push_back(
        OneValue("process_open_fds", "Files and connections that are open.", MetricType::Gauge, process.open_files));
    const std::lock_guard lock(mutex_);
    if (!read_) return families;
    const Readings now = read_();
    const SchedulerLoad::User jobs = now.load.Total();
    families.push_back({"flatlight_jobs",
                        "Jobs that have not ended.",
                        MetricType::Gauge,
                        {Labelled("state", "waiting", static_cast<double>(jobs.waiting)),
                         Labelled("state", "running", static_cast<double>(jobs.running)),
                         Labelled("state", "paused", static_cast<double>(jobs.paused))}});
    families.push_back(OneValue("flatlight_watches", "Watches that are open.", MetricType::Gauge, now.watches));
    families.push_back(
        {"flatlight_watches_total",
         "Watches that were begun: new, or resumed where an earlier one ended.",
         MetricType::Counter,
         {Labelled("start", "new", now.new_watches), Labelled("start", "resumed", now.resumed_watches)}});
    families.push_back(OneValue("flatlight_watch_updates_total", "States of jobs sent to watchers.",
                                MetricType::Counter, now.updates));
    families.push_back(OneValue("flatlight_watch_conflated_updates_total",
                                "States of jobs that watchers were spared, as newer ones came first.",
                                MetricType::Counter, now.conflated));
    families.push_back(OneValue("flatlight_log_lines_lost_total", "Lines that could not be written to a log.",
                                MetricType::Counter, now.lost_log_lines));
    families.push_back(OneValue("flatlight_webhooks_open", "Webhooks that wait for their job, or to be taken.",
                                MetricType::Gauge, now.open_webhooks));
    families.push_back(OneValue("flatlight_storage_healthy", "1 while the data folder can be written, else 0.",
                                MetricType::Gauge, now.storage_healthy ? 1 : 0));
    return families;
  }

 private:
  mutable std::mutex mutex_;
  std::function<Readings()> read_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace

class Metrics::Method {
 public:
  explicit Method(std::string its_name) : name(std::move(its_name)) {}

  const std::string name;
  std::array<std::atomic<prometheus::Counter*>, kCodes> calls = {};  // By code.
  std::atomic<prometheus::Histogram*> seconds = nullptr;
  std::atomic<prometheus::Counter*> sent = nullptr;
};

struct Metrics::Parts {
  std::mutex mutex;
  std::map<std::string, std::unique_ptr<Method>> methods ABSL_GUARDED_BY(mutex);
  std::shared_ptr<prometheus::Registry> registry = std::make_shared<prometheus::Registry>();
  std::shared_ptr<Looks> looks = std::make_shared<Looks>();
  std::unique_ptr<prometheus::Exposer> exposer;

  prometheus::Family<prometheus::Counter>& Counters(const char* name, const char* help) {
    return prometheus::BuildCounter().Name(name).Help(help).Register(*registry);
  }
  prometheus::Family<prometheus::Histogram>& Histograms(const char* name, const char* help) {
    return prometheus::BuildHistogram().Name(name).Help(help).Register(*registry);
  }
  std::array<prometheus::Histogram*, kJobClasses> ByClass(const char* name, const char* help) {
    auto& family = Histograms(name, help);
    std::array<prometheus::Histogram*, kJobClasses> histograms{};
    for (std::size_t i = 0; i < kJobClasses; ++i) {
      histograms[i] = &family.Add({{"class", NameOf(static_cast<JobClass>(i))}}, kWaits);
    }
    return histograms;
  }

  std::array<prometheus::Histogram*, kJobClasses> queue_wait =
      ByClass("flatlight_queue_wait_seconds", "How long jobs waited for a place to run, pauses left out.");
  std::array<prometheus::Histogram*, kJobClasses> first_picture =
      ByClass("flatlight_first_picture_seconds", "From the acceptance of a job to its first picture, pauses left out.");
  prometheus::Histogram& cancel_latency =
      Histograms("flatlight_cancel_latency_seconds", "From the wish to cancel a job to the end of all work for it.")
          .Add({}, kWaits);
  prometheus::Counter& rays = Counters("flatlight_rays_total", "Rays traced.").Add({});
  prometheus::Counter& job_cpu =
      Counters("flatlight_job_cpu_seconds_total", "Processor time of preparing and rendering.").Add({});
  prometheus::Family<prometheus::Counter>& ended = Counters("flatlight_jobs_ended_total", "Jobs that have ended.");
  prometheus::Family<prometheus::Counter>& calls =
      Counters("flatlight_calls_total", "Calls that were answered, streams at their end.");
  prometheus::Family<prometheus::Histogram>& call_seconds =
      Histograms("flatlight_call_seconds", "How long calls took, streams to their end.");
  prometheus::Family<prometheus::Counter>& refusals =
      Counters("flatlight_refusals_total", "Calls that were answered by an error, by its reason.");
  prometheus::Counter& expired =
      Counters("flatlight_jobs_expired_total", "Jobs that were removed as their time was over.").Add({});
  prometheus::Family<prometheus::Counter>& webhooks =
      Counters("flatlight_webhook_attempts_total", "Attempts to tell of a job's end, by what came of them.");
  prometheus::Family<prometheus::Counter>& sent =
      Counters("flatlight_sent_bytes_total", "Bytes of answers, before compression and framing.");
};

Metrics::Metrics(const std::string& version) : parts_(std::make_unique<Parts>()) {
  prometheus::BuildGauge()
      .Name("flatlight_build_info")
      .Help("1; the label names the build.")
      .Register(*parts_->registry)
      .Add({{"version", version}})
      .Set(1);
  for (const JobPhase phase : {JobPhase::kSucceeded, JobPhase::kFailed, JobPhase::kCancelled}) {
    parts_->ended.Add({{"state", NameOf(phase)}});
  }
}

Metrics::~Metrics() = default;

void Metrics::Admitted(const JobSpec& spec, Clock::Duration waited) {
  parts_->queue_wait[static_cast<std::size_t>(spec.job_class)]->Observe(Seconds(waited));
}

void Metrics::FirstPicture(const JobSpec& spec, Clock::Duration since_entry) {
  parts_->first_picture[static_cast<std::size_t>(spec.job_class)]->Observe(Seconds(since_entry));
}

void Metrics::Worked(const JobSpec& /*spec*/, double rays, double cpu_seconds) {
  parts_->rays.Increment(rays);
  parts_->job_cpu.Increment(cpu_seconds);
}

void Metrics::Cancelled(const JobSpec& /*spec*/, Clock::Duration latency) {
  parts_->cancel_latency.Observe(Seconds(latency));
}

void Metrics::Ended(const JobSpec& /*spec*/, const JobState& state) {
  parts_->ended.Add({{"state", NameOf(state.phase)}}).Increment();
}

Metrics::Method& Metrics::MethodOf(const std::string& name) {
  const std::lock_guard lock(parts_->mutex);
  auto& method = parts_->methods[name];
  if (method == nullptr) method = std::make_unique<Method>(name);
  return *method;
}

void Metrics::CallEnded(Method& method, absl::StatusCode code, const std::string& reason, double seconds,
                        double sent_bytes) {
  // To find a series by its labels costs more than all the rest; twice found, it is the same.
  const auto find = [](auto& known, auto add) -> auto& {
    auto* series = known.load(std::memory_order_acquire);
    if (series == nullptr) {
      series = add();
      known.store(series, std::memory_order_release);
    }
    return *series;
  };
  find(method.calls[static_cast<std::size_t>(code) % kCodes], [&] {
    return &parts_->calls.Add({{"method", method.name}, {"code", absl::StatusCodeToString(code)}});
  }).Increment();
  find(method.seconds, [&] { return &parts_->call_seconds.Add({{"method", method.name}}, kCalls); }).Observe(seconds);
  if (sent_bytes > 0) {
    find(method.sent, [&] { return &parts_->sent.Add({{"method", method.name}}); }).Increment(sent_bytes);
  }
  if (!reason.empty()) parts_->refusals.Add({{"reason", reason}}).Increment();
}

void Metrics::JobExpired() { parts_->expired.Increment(); }

void Metrics::WebhookTried(const std::string& outcome) { parts_->webhooks.Add({{"outcome", outcome}}).Increment(); }

void Metrics::ReadWith(std::function<Readings()> read) { parts_->looks->ReadWith(std::move(read)); }

void Metrics::Close() {
  parts_->exposer.reset();
  parts_->looks->ReadWith(nullptr);
}

Readings Metrics::Read() const { return parts_->looks->Read(); }

double Metrics::rays() const { return parts_->rays.Value(); }

double Metrics::job_cpu_seconds() const { return parts_->job_cpu.Value(); }

std::string Metrics::Text() const {
  std::vector<MetricFamily> families = parts_->registry->Collect();
  for (MetricFamily& family : parts_->looks->Collect()) families.push_back(std::move(family));
  return prometheus::TextSerializer().Serialize(families);
}

absl::StatusOr<std::string> Metrics::Expose(const std::string& host, int port) {
  const std::string address = host + ":" + std::to_string(port);
  try {
    auto exposer = std::make_unique<prometheus::Exposer>(address, 1);
    exposer->RegisterCollectable(parts_->registry);
    exposer->RegisterCollectable(parts_->looks);
    const std::vector<int> ports = exposer->GetListeningPorts();
    parts_->exposer = std::move(exposer);
    return host + ":" + std::to_string(ports.empty() ? port : ports.front());
  } catch (const std::exception&) {
    return MakeError(absl::StatusCode::kUnavailable, "CANNOT_LISTEN", "cannot serve metrics on " + address);
  }
}

}  // namespace flatlight
