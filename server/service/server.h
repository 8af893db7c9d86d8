// SPDX-License-Identifier: Apache-2.0
// A whole server in one object: what flatlightd runs, and tests too.
#ifndef FLATLIGHT_SERVER_SERVICE_SERVER_H_
#define FLATLIGHT_SERVER_SERVICE_SERVER_H_

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "core/execution/clock.h"
#include "core/render/index_cache.h"
#include "server/quota/quotas.h"
#include "server/scheduler/scheduler.h"
#include "server/service/limits.h"
#include "server/service/tls_files.h"
#include "server/store/retention.h"
#include "server/webhook/webhook_rules.h"
#include "server/webhook/webhook_sender.h"

namespace flatlight {

struct ServerOptions {
  // An address of this machine and a port (0: any free one), or unix:PATH. One that other machines can reach wants TLS,
  // and a token or users.
  std::string address = "127.0.0.1:0";
  TlsFiles tls;
  std::string token;  // What callers must present; empty: nothing.
  int threads = 1;    // For rendering.
  std::string data;   // A folder for what is to outlive the process; empty: nothing does.
  Limits limits;
  QuotaTable quotas;
  Retention retention;         // Of jobs that have ended.
  WebhookRules webhook_rules;  // Who may be told of the end of jobs: nobody.
  WebhookSender::Options webhooks;
  std::string metrics_address;  // A loopback address and port for Prometheus; empty: none is served.
  std::string log;              // A file for a line about each call, or "-"; empty: none.
  std::chrono::milliseconds checkpoint_interval{3000};  // Of a job, at least. With `data`.
  std::chrono::milliseconds keepalive{60'000};          // See SetConnectionLimits.
  std::size_t connection_memory_bytes = 512u << 20;     // Of gRPC's buffers; a thousand watchers take an eighth.
  std::chrono::milliseconds heartbeat{10'000};          // Between messages of a watch on which nothing happens.
  // Tests give their own: of quotas for requests (null: that of the machine), and of the day of UTC.
  const Clock* request_clock = nullptr;
  std::function<std::chrono::system_clock::time_point()> day_clock = std::chrono::system_clock::now;
  std::function<std::chrono::system_clock::time_point()> retention_clock = std::chrono::system_clock::now;
  std::chrono::milliseconds retention_interval{0};  // Between looks for jobs that have expired; 0: see JobSweeper.
  // Tests give their own, which outlives the server; null: it has one of its own.
  IndexCache* indexes = nullptr;
  // Tests give their own; else StartRendering, on indexes that jobs share (JobSpec::sharers).
  std::function<std::unique_ptr<Rendering>(std::shared_ptr<const Scene>, const Plan&)> start_rendering;
};

class Server {
 public:
  // Serves from now on. INVALID_ARGUMENT for an address that is not allowed, TLS files that cannot be used, or with
  // NO_USERS where strangers could come in; UNAVAILABLE, with the reason, where it cannot listen or use the folder.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const ServerOptions& options);
  // As Drain without grace.
  ~Server();

  // Where it can be reached: the address with the port it has.
  const std::string& address() const;
  // Where its metrics are served; empty if they are not.
  const std::string& metrics_address() const;
  // What a Prometheus server would read.
  std::string MetricsText() const;
  // Opens logs anew that were moved away. An error names the one that could not be.
  absl::Status ReopenLogs();
  // Ends: health says NOT_SERVING, new jobs are refused, watchers are told; jobs are written down as far as they are,
  // or, without a folder, cancelled; calls under way get `grace` to end. Returns when all has ended.
  void Drain(std::chrono::milliseconds grace);

 private:
  struct Parts;
  explicit Server(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_SERVER_H_
