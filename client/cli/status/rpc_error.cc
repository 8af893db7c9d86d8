// SPDX-License-Identifier: Apache-2.0
#include "client/cli/status/rpc_error.h"

#include <cmath>
#include <cstdint>
#include <string>

#include "google/rpc/error_details.pb.h"

namespace flatlight {
namespace {

void AddLine(const std::string& place, const std::string& description, std::string& lines) {
  if (!lines.empty()) lines += '\n';
  lines += place.empty() ? description : place + ": " + description;
}

// "12 s", "57 min", "5 h": rounded up, so that who waits as long has waited long enough.
std::string TimeText(const google::protobuf::Duration& duration) {
  const double seconds = static_cast<double>(duration.seconds()) + 1e-9 * duration.nanos();
  const auto whole = [](double value) { return std::to_string(static_cast<std::int64_t>(std::ceil(value))); };
  if (seconds <= 120) return whole(seconds) + " s";
  if (seconds <= 7200) return whole(seconds / 60) + " min";
  return whole(seconds / 3600) + " h";
}

std::string Violations(const google::rpc::Status& status) {
  std::string lines;
  std::string retry;
  for (const google::protobuf::Any& detail : status.details()) {
    google::rpc::BadRequest bad_request;
    google::rpc::QuotaFailure quota;
    google::rpc::RetryInfo retry_info;
    if (detail.UnpackTo(&bad_request)) {
      for (const auto& violation : bad_request.field_violations())
        AddLine(violation.field(), violation.description(), lines);
    } else if (detail.UnpackTo(&quota)) {
      for (const auto& violation : quota.violations()) AddLine(violation.subject(), violation.description(), lines);
    } else if (detail.UnpackTo(&retry_info)) {
      retry = " (try again in " + TimeText(retry_info.retry_delay()) + ")";
    }
  }
  return lines.empty() ? lines : lines + retry;
}

// DATA_LOSS means an output of ours that could not be written; a server that reports it has failed.
absl::StatusCode Code(int code) {
  const auto known = static_cast<absl::StatusCode>(code);
  return known == absl::StatusCode::kDataLoss ? absl::StatusCode::kInternal : known;
}

}  // namespace

absl::Status ErrorFromRpc(const google::rpc::Status& status) {
  std::string message = Violations(status);
  if (message.empty()) message = status.message();
  if (message.empty()) message = "the server gave no reason (status " + std::to_string(status.code()) + ")";
  return absl::Status(Code(status.code()), message);
}

absl::Status ErrorFromRpc(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) details.Clear();
  details.set_code(status.error_code());
  details.set_message(status.error_message());
  return ErrorFromRpc(details);
}

}  // namespace flatlight
