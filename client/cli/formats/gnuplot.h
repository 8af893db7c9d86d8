// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_GNUPLOT_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_GNUPLOT_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace flatlight {

// FAILED_PRECONDITION with a hint if gnuplot is not in PATH.
absl::Status FindGnuplot();

// Runs gnuplot on a script, without a shell, and returns the picture that it writes to its standard output.
absl::StatusOr<std::string> RunGnuplot(const std::string& script);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_GNUPLOT_H_
