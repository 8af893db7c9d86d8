// SPDX-License-Identifier: Apache-2.0
#include "client/cli/status/exit_code.h"

namespace flatlight {

ExitCode ExitCodeOf(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return ExitCode::kDone;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kNotFound:
    case absl::StatusCode::kAlreadyExists:
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kOutOfRange:
      return ExitCode::kUsage;
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
      return ExitCode::kUnreachable;
    case absl::StatusCode::kUnauthenticated:
    case absl::StatusCode::kPermissionDenied:
    case absl::StatusCode::kResourceExhausted:
      return ExitCode::kDenied;
    case absl::StatusCode::kDataLoss:
      return ExitCode::kOutput;
    case absl::StatusCode::kCancelled:
      return ExitCode::kInterrupted;
    default:
      return ExitCode::kJobFailed;
  }
}

absl::Status UsageError(const std::string& message) { return absl::InvalidArgumentError(message); }

absl::Status OutputError(const std::string& place, const std::string& reason) {
  return absl::DataLossError(place + " could not be written: " + reason);
}

absl::Status JobError(const std::string& message) { return absl::InternalError(message); }

absl::Status InterruptedError(const std::string& message) { return absl::CancelledError(message); }

}  // namespace flatlight
