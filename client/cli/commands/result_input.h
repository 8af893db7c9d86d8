// SPDX-License-Identifier: Apache-2.0
// Results that a command reads.
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_INPUT_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_INPUT_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/connection/interruption.h"
#include "flatlight/v1/render_service.pb.h"

namespace flatlight {

// A result in JSON form; "-" is standard input.
absl::StatusOr<v1::RenderResult> ReadResult(const std::string& path, const Interruption& interruption);

// What --records names: "jobs/UUID" or a result with cache records. Absent if it is empty.
absl::StatusOr<std::optional<v1::KnownRecords>> ReadKnownRecords(const std::string& text,
                                                                 const Interruption& interruption);

// The same error, which says that it is about --records if it is.
absl::Status ExplainRecordsError(const std::string& text, const absl::Status& status);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_INPUT_H_
