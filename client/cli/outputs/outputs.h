// SPDX-License-Identifier: Apache-2.0
// Where a result goes: the files of -o, and standard output.
#ifndef FLATLIGHT_CLIENT_CLI_OUTPUTS_OUTPUTS_H_
#define FLATLIGHT_CLIENT_CLI_OUTPUTS_OUTPUTS_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "flatlight/v1/result.pb.h"

namespace flatlight {

enum class OutputForm { kJson, kCsv, kNpy, kSvg, kPng, kExr, kHdr };

struct Output {
  std::string path;  // "-" is standard output.
  OutputForm form = OutputForm::kJson;
};

// The endings of the forms, for messages and help: ".json .csv .npy .svg .png .exr .hdr".
std::string OutputEndings();

// The form of every path by its ending, in any case ("-" is JSON). Everything that can be known before the work starts
// is checked: endings and doubles (bad usage), folders, rights, and the programs that draw (not writable).
absl::StatusOr<std::vector<Output>> PlanOutputs(const std::vector<std::string>& paths);

bool WritesToStandardOutput(const std::vector<Output>& outputs);

// Each file is there whole or not at all. Goes on after a failure, so that the rest of the work is not lost; the error
// then has a line for each failure. As soon as `interrupted` says so, nothing more is written, and the error ends with
// ExitCode::kInterrupted; files that were there by then stay.
absl::Status WriteOutputs(const v1::RenderResult& result, const std::vector<Output>& outputs,
                          const std::function<bool()>& interrupted);

// To standard output, at once.
absl::Status PrintBytes(const std::string& bytes);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OUTPUTS_OUTPUTS_H_
