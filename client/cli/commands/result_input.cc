// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/result_input.h"

#include <cstdint>

#include "client/cli/formats/json_text.h"
#include "client/cli/scenes/scene_file.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::uint64_t kMaxResultBytes = 2'000'000'000;  // Protobuf's own limit is 2 GiB.

}  // namespace

absl::StatusOr<v1::RenderResult> ReadResult(const std::string& path, const Interruption& interruption) {
  const std::string label = path == "-" ? "standard input" : Printable(path);
  const auto bytes = ReadFile(path, label, kMaxResultBytes, interruption);
  if (!bytes.ok()) return bytes.status();
  return ResultFromJson(*bytes, label);
}

absl::StatusOr<std::optional<v1::KnownRecords>> ReadKnownRecords(const std::string& text,
                                                                 const Interruption& interruption) {
  if (text.empty()) return std::optional<v1::KnownRecords>();
  v1::KnownRecords known;
  if (text.rfind("jobs/", 0) == 0) {
    known.set_job(text);
    return std::optional(known);
  }
  const auto result = ReadResult(text, interruption);
  if (!result.ok()) return result.status();
  if (result->records().empty() || !result->has_records_seal())
    return UsageError(Printable(text) + " holds no records: it must be a result of irradiance-caching");
  *known.mutable_records() = result->records();
  *known.mutable_seal() = result->records_seal();
  return std::optional(known);
}

absl::Status ExplainRecordsError(const std::string& text, const absl::Status& status) {
  const std::string message(status.message().data(), status.message().size());
  if (text.empty() || message.rfind("records", 0) != 0) return status;
  const std::size_t reason = message.find(": ");
  absl::Status explained(status.code(), "--records " + Printable(text) + ": the records " +
                                            (reason == std::string::npos ? message : message.substr(reason + 2)));
  status.ForEachPayload([&](absl::string_view url, const absl::Cord& payload) { explained.SetPayload(url, payload); });
  return explained;
}

}  // namespace flatlight
