// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_JOBS_WATCH_H_
#define FLATLIGHT_CLIENT_CLI_JOBS_WATCH_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

struct WatchOptions {
  double max_rate = 10;               // Updates a second.
  bool cancel_on_disconnect = false;  // The server cancels the job when it loses the watch.
  // A stream that breaks is taken up again where it ended, for as long as no more than this passes without a message.
  std::chrono::milliseconds patience = std::chrono::seconds(120);
  std::chrono::milliseconds silence = std::chrono::seconds(25);  // Heartbeats come every 10 s.
  // With the newest state, never going back; an error ends the watch. May be empty, as the next ones.
  std::function<absl::Status(const v1::Job&)> on_update;
  // With each cache record once, in order of its index; an error ends the watch.
  std::function<absl::Status(std::uint32_t index, const v1::CacheRecord&)> on_record;
  std::function<absl::Status()> check_server;  // Asked before every new try; an error ends the watch.
};

bool HasEnded(v1::Job::State state);

// Watches a job until it has ended and returns it. INTERRUPTED after a signal; the job goes on.
absl::StatusOr<v1::Job> WatchJob(Connection& connection, const std::string& name, const WatchOptions& options);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_JOBS_WATCH_H_
