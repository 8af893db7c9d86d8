// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_JOBS_COMEBACK_H_
#define FLATLIGHT_CLIENT_CLI_JOBS_COMEBACK_H_

#include <chrono>
#include <random>

#include "absl/status/status.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

// Whether the same call may well succeed a little later.
bool MayComeBack(const grpc::Status& status);

// Waits between the tries to take a broken stream up again.
class Comeback {
 public:
  // Gives up when no message came for longer than `patience`.
  Comeback(Connection& connection, std::chrono::milliseconds patience) : connection_(connection), patience_(patience) {}

  // A message came.
  void Heard();
  // Before the next try, after one that ended so. UNAVAILABLE when it is time to give up, INTERRUPTED after a signal.
  absl::Status Wait(const grpc::Status& status);

 private:
  Connection& connection_;
  const std::chrono::milliseconds patience_;
  int failures_ = 0;
  std::chrono::steady_clock::time_point last_message_ = std::chrono::steady_clock::now();
  std::minstd_rand random_{std::random_device()()};
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_JOBS_COMEBACK_H_
