// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/retry.h"

#include <algorithm>

#include "google/protobuf/descriptor.h"
#include "google/protobuf/descriptor.pb.h"
#include "google/protobuf/util/time_util.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/error_info.pb.h"
#include "google/rpc/status.pb.h"

namespace flatlight {
namespace {

using google::protobuf::MethodOptions;
using std::chrono::milliseconds;

constexpr milliseconds kFirstWait{250};
constexpr milliseconds kMostWait{2000};

// What a server said of a refusal.
struct Refusal {
  std::string reason;  // Empty: it was not a server of ours that spoke.
  std::optional<milliseconds> retry_delay;
};

Refusal RefusalOf(const grpc::Status& status) {
  Refusal refusal;
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) return refusal;
  for (const google::protobuf::Any& detail : details.details()) {
    google::rpc::ErrorInfo info;
    google::rpc::RetryInfo retry;
    if (detail.UnpackTo(&info)) {
      refusal.reason = info.reason();
    } else if (detail.UnpackTo(&retry)) {
      refusal.retry_delay = milliseconds(google::protobuf::util::TimeUtil::DurationToMilliseconds(retry.retry_delay()));
    }
  }
  return refusal;
}

}  // namespace

bool IsRepeatable(const google::protobuf::Message& request) {
  const google::protobuf::Descriptor& type = *request.GetDescriptor();
  if (const auto* id = type.FindFieldByName("request_id"); id != nullptr) {
    return !request.GetReflection()->GetString(request, id).empty();
  }
  // Each method has a type of request of its own.
  for (int s = 0; s < type.file()->service_count(); ++s) {
    const google::protobuf::ServiceDescriptor& service = *type.file()->service(s);
    for (int m = 0; m < service.method_count(); ++m) {
      if (service.method(m)->input_type() != &type) continue;
      return service.method(m)->options().idempotency_level() != MethodOptions::IDEMPOTENCY_UNKNOWN;
    }
  }
  return false;
}

milliseconds DoublingWait(milliseconds first, milliseconds most, int failures, double chance) {
  const double whole = std::min(static_cast<double>(most.count()),
                                static_cast<double>(first.count()) * (1 << std::clamp(failures - 1, 0, 10)));
  return milliseconds(static_cast<long>(whole * (0.5 + 0.5 * chance)));
}

std::optional<milliseconds> Retry::Next(const grpc::Status& status, double chance) {
  const grpc::StatusCode code = status.error_code();
  if (code != grpc::StatusCode::RESOURCE_EXHAUSTED && code != grpc::StatusCode::UNAVAILABLE) return std::nullopt;
  if (++tries_ >= kMostTries) return std::nullopt;
  const Refusal refusal = RefusalOf(status);
  if (refusal.retry_delay) {
    if (*refusal.retry_delay > kLongestDelay) return std::nullopt;
    why_ = "the server refuses for now (" + refusal.reason + ")";
    return std::chrono::duration_cast<milliseconds>(*refusal.retry_delay * (1 + 0.25 * chance)) + milliseconds(1);
  }
  // A server that gives a reason and no time, such as a disk that may not be written, does not mend soon.
  if (code != grpc::StatusCode::UNAVAILABLE || !refusal.reason.empty() || !repeatable_) return std::nullopt;
  why_ = "no answer from the server";
  return DoublingWait(kFirstWait, kMostWait, tries_, chance);
}

}  // namespace flatlight
