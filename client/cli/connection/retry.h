// SPDX-License-Identifier: Apache-2.0
// Whether and when a call that was refused, or did not reach the server, is made again.
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_RETRY_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_RETRY_H_

#include <chrono>
#include <optional>
#include <string>

#include "google/protobuf/message.h"
#include "grpcpp/support/status.h"

namespace flatlight {

// Whether making a call twice comes to the same as making it once: its method says so in the .proto
// (idempotency_level), or the request has a request_id by which the server knows it again.
bool IsRepeatable(const google::protobuf::Message& request);

// A wait that doubles from `first` to `most`, of which a part in [1/2, 1] given by `chance` in [0, 1), so that many who
// lost the same server do not call in step. `failures` counts from 1.
std::chrono::milliseconds DoublingWait(std::chrono::milliseconds first, std::chrono::milliseconds most, int failures,
                                       double chance);

// The tries of one unary call.
class Retry {
 public:
  static constexpr int kMostTries = 5;
  // What takes longer is for the user to wait for.
  static constexpr std::chrono::seconds kLongestDelay{10};

  explicit Retry(bool repeatable) : repeatable_(repeatable) {}

  // How long to wait before the next try, after one that ended with `status`; absent: there is none. A server that says
  // when to try again (RetryInfo) has not done what was asked, so any call is made again: not sooner, and up to a
  // quarter later, by `chance` in [0, 1). Whether one was done that found no server, or lost it, nobody knows:
  // repeatable ones alone are made again.
  std::optional<std::chrono::milliseconds> Next(const grpc::Status& status, double chance);
  // Why the last try failed, for the user: "the server refuses for now (TOO_MANY_JOBS)".
  const std::string& why() const { return why_; }
  int tries_left() const { return kMostTries - tries_; }

 private:
  const bool repeatable_;
  int tries_ = 0;  // That have failed.
  std::string why_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_RETRY_H_
