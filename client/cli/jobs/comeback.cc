// SPDX-License-Identifier: Apache-2.0
#include "client/cli/jobs/comeback.h"

#include "client/cli/connection/retry.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"

namespace flatlight {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

namespace {

constexpr milliseconds kFirstWait{50};
constexpr milliseconds kMostWait{2000};

}  // namespace

bool MayComeBack(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::OK:  // Ended too early.
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::CANCELLED:
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::INTERNAL:  // Also gRPC's own, of a broken connection.
    case grpc::StatusCode::UNKNOWN:
      return true;
    default:
      return false;
  }
}

void Comeback::Heard() {
  failures_ = 0;
  last_message_ = steady_clock::now();
}

absl::Status Comeback::Wait(const grpc::Status& status) {
  if (steady_clock::now() - last_message_ > patience_)
    return absl::UnavailableError("lost the server at " + connection_.address() + " for more than " +
                                  FormatSeconds(std::chrono::duration<double>(patience_).count()) + ": " +
                                  status.error_message());
  const double chance = std::uniform_real_distribution<double>(0, 1)(random_);
  if (!connection_.interruption().Sleep(DoublingWait(kFirstWait, kMostWait, ++failures_, chance)))
    return InterruptedError("interrupted");
  return absl::OkStatus();
}

}  // namespace flatlight
