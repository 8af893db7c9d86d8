// SPDX-License-Identifier: Apache-2.0
// How a command ends. Errors travel as absl::Status; its code alone decides the exit status of the program.
#ifndef FLATLIGHT_CLIENT_CLI_STATUS_EXIT_CODE_H_
#define FLATLIGHT_CLIENT_CLI_STATUS_EXIT_CODE_H_

#include <string>

#include "absl/status/status.h"

namespace flatlight {

enum class ExitCode : int {
  kDone = 0,          // A time limit that was reached is done, too.
  kJobFailed = 1,     // The job failed, or the server made a mistake.
  kUsage = 2,         // Bad usage, a bad scene, an unknown job, results that cannot be compared.
  kUnreachable = 3,   // The server could not be reached, or was lost.
  kDenied = 4,        // Not allowed, or over quota.
  kOutput = 5,        // An output could not be written.
  kDiffers = 10,      // `compare` found a difference.
  kInterrupted = 130  // By SIGINT, SIGTERM or SIGHUP.
};

ExitCode ExitCodeOf(const absl::Status& status);

// Bad usage or a bad scene: ends with kUsage. The message says what, which value, and what is allowed.
absl::Status UsageError(const std::string& message);

// `place` ("out/a.json", "standard output") could not be written: ends with kOutput.
absl::Status OutputError(const std::string& place, const std::string& reason);

// The job or the server failed: ends with kJobFailed.
absl::Status JobError(const std::string& message);

// The user broke off: ends with kInterrupted.
absl::Status InterruptedError(const std::string& message);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_STATUS_EXIT_CODE_H_
