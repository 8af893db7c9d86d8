// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_TELEMETRY_METRICS_H_
#define FLATLIGHT_SERVER_TELEMETRY_METRICS_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/scheduler/scheduler_events.h"

namespace flatlight {

// What is read when somebody asks, rather than counted.
struct Readings {
  SchedulerLoad load;
  double watches = 0;          // Open.
  double new_watches = 0;      // Since the start, as all below.
  double resumed_watches = 0;  // That went on where an earlier one ended.
  double updates = 0;          // Complete states sent.
  double conflated = 0;        // States that a watcher was spared, as newer ones came before it could take them.
  double lost_log_lines = 0;
  double open_webhooks = 0;  // At this moment, as the next.
  bool storage_healthy = true;
};

// All that a server measures, in the words of Prometheus. Labels are few and known: no user, no job. Safe to use from
// any thread.
class Metrics final : public SchedulerEvents {
 public:
  explicit Metrics(const std::string& version);
  ~Metrics() override;

  void Admitted(const JobSpec& spec, Clock::Duration waited) override;
  void FirstPicture(const JobSpec& spec, Clock::Duration since_entry) override;
  void Worked(const JobSpec& spec, double rays, double cpu_seconds) override;
  void Cancelled(const JobSpec& spec, Clock::Duration latency) override;
  void Ended(const JobSpec& spec, const JobState& state) override;

  // Calls of one method. The series are found once, and shown from the first call on.
  class Method;
  // Of "Service/Method"; it lives as long as this.
  Method& MethodOf(const std::string& name);
  // A call has its answer: `reason` of an error's ErrorInfo, empty if there is none.
  void CallEnded(Method& method, absl::StatusCode code, const std::string& reason, double seconds, double sent_bytes);
  // A job was removed as its time was over.
  void JobExpired();
  // One attempt to tell of a job's end, by what came of it.
  void WebhookTried(const std::string& outcome);
  // Called at each look until Close.
  void ReadWith(std::function<Readings()> read);
  void Close();

  // What is read at this moment; nothing after Close.
  Readings Read() const;
  // Since the start.
  double rays() const;
  double job_cpu_seconds() const;

  // Prometheus' text format.
  std::string Text() const;
  // Serves it at http://HOST:PORT/metrics from now on; returns the address with the port it has. UNAVAILABLE if it
  // cannot listen there.
  absl::StatusOr<std::string> Expose(const std::string& host, int port);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_TELEMETRY_METRICS_H_
