// SPDX-License-Identifier: Apache-2.0
#include "server/service/status_convert.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include "absl/strings/cord.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/error_info.pb.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr char kBadRequest[] = "flatlight/bad-request";
constexpr char kViolations[] = "flatlight/violations";

// In the trailers the message stands twice (as grpc-message, up to three bytes a character) and the details in base64:
// 3 * 900 + 4/3 * 3300 < 7200 bytes, which leaves room for other trailers.
constexpr std::size_t kMaxMessageBytes = 900;
constexpr std::size_t kMaxDetailsBytes = 3300;
constexpr std::size_t kMaxViolationBytes = 400;

// At most `limit` bytes, without cutting a UTF-8 character.
std::string Shorten(const std::string& text, std::size_t limit) {
  if (text.size() <= limit) return text;
  std::size_t end = limit - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end) + "...";
}

void AddViolation(const Diagnostic& diagnostic, google::rpc::BadRequest& bad_request) {
  auto* violation = bad_request.add_field_violations();
  violation->set_field(Shorten(diagnostic.path, kMaxViolationBytes));
  violation->set_description(Shorten(diagnostic.message, kMaxViolationBytes));
}

std::string Payload(const absl::Status& status, const char* key) {
  const auto payload = status.GetPayload(key);
  return payload ? std::string(*payload) : std::string();
}

void AddQuota(const QuotaViolation& quota, const std::string& message, google::rpc::Status& status) {
  google::rpc::QuotaFailure failure;
  auto* violation = failure.add_violations();
  violation->set_subject(quota.subject);
  violation->set_description(message);
  status.add_details()->PackFrom(failure);
}

void AddRetry(std::chrono::milliseconds after, google::rpc::Status& status) {
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(after.count() / 1000);
  retry.mutable_retry_delay()->set_nanos(static_cast<int>(after.count() % 1000) * 1'000'000);
  status.add_details()->PackFrom(retry);
}

// "12", "12.5".
std::string NumberText(double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.15g", value);
  return text.data();
}

// The first violations that fit in; returns how many.
int AddViolations(const std::string& payload, google::rpc::Status& status) {
  google::rpc::BadRequest all;
  if (!all.ParseFromString(payload)) return 0;
  google::rpc::BadRequest kept;
  std::size_t bytes = status.ByteSizeLong();
  for (auto& violation : *all.mutable_field_violations()) {
    bytes += violation.ByteSizeLong() + 4;
    if (bytes > kMaxDetailsBytes) break;
    kept.add_field_violations()->Swap(&violation);
  }
  status.add_details()->PackFrom(kept);
  return kept.field_violations_size();
}

}  // namespace

absl::Status MakeDiagnosticsError(const std::string& reason, const std::string& what, const Diagnostics& diagnostics) {
  const std::vector<Diagnostic>& kept = diagnostics.kept();
  std::string message =
      what + " has " + (diagnostics.count() == 1 ? "a mistake" : std::to_string(diagnostics.count()) + " mistakes");
  if (!kept.empty()) {
    message += diagnostics.count() == 1 ? ": " : ", first: ";
    message += (kept[0].path.empty() ? "" : kept[0].path + ": ") + kept[0].message;
  }
  absl::Status error = MakeError(absl::StatusCode::kInvalidArgument, reason, message);
  google::rpc::BadRequest bad_request;
  for (const Diagnostic& diagnostic : kept) AddViolation(diagnostic, bad_request);
  error.SetPayload(kBadRequest, absl::Cord(bad_request.SerializeAsString()));
  error.SetPayload(kViolations, absl::Cord(std::to_string(diagnostics.count())));
  return error;
}

absl::Status MakeFieldError(const std::string& path, const std::string& message) {
  Diagnostics diagnostics;
  diagnostics.Add(path, message);
  return MakeDiagnosticsError("BAD_REQUEST", "the request", diagnostics);
}

google::rpc::Status ToRpcStatus(const absl::Status& status) {
  google::rpc::Status result;
  result.set_code(static_cast<int>(status.code()));
  if (status.ok()) return result;
  result.set_message(Shorten(std::string(status.message()), kMaxMessageBytes));
  google::rpc::ErrorInfo info;
  info.set_domain("flatlight");
  const std::string reason = ReasonOf(status);
  info.set_reason(reason.empty() ? absl::StatusCodeToString(status.code()) : reason);
  if (const auto quota = QuotaViolationOf(status)) {
    AddQuota(*quota, result.message(), result);
    if (quota->use) {
      (*info.mutable_metadata())["used"] = NumberText(quota->use->used);
      (*info.mutable_metadata())["allowed"] = NumberText(quota->use->allowed);
    }
  }
  if (const auto after = RetryAfterOf(status)) AddRetry(*after, result);
  if (const std::string payload = Payload(status, kBadRequest); !payload.empty()) {
    const int kept = AddViolations(payload, result);
    const std::string total = Payload(status, kViolations);
    const long long more = std::atoll(total.c_str()) - kept;
    if (more > 0) (*info.mutable_metadata())["more_violations"] = std::to_string(more);
  }
  result.add_details()->PackFrom(info);
  return result;
}

std::string ReasonOf(const google::rpc::Status& status) {
  for (const auto& detail : status.details()) {
    google::rpc::ErrorInfo info;
    if (detail.UnpackTo(&info)) return info.reason();
  }
  return "";
}

absl::Status FromRpcStatus(const google::rpc::Status& status) {
  return MakeError(static_cast<absl::StatusCode>(status.code()), ReasonOf(status), status.message());
}

grpc::Status ToGrpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const google::rpc::Status rpc = ToRpcStatus(status);
  return {static_cast<grpc::StatusCode>(rpc.code()), rpc.message(), rpc.SerializeAsString()};
}

}  // namespace flatlight
