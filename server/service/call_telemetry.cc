// SPDX-License-Identifier: Apache-2.0
#include "server/service/call_telemetry.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "google/rpc/status.pb.h"
#include "server/service/status_convert.h"
#include "server/store/random_bytes.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxRequestIdBytes = 128;
constexpr std::string_view kPackage = "/flatlight.v1.";
constexpr char kOtherMethods[] = "other";  // Health, reflection, and names that strangers think of.

bool IsRequestId(const grpc::string_ref& text) {
  return !text.empty() && text.size() <= kMaxRequestIdBytes &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~' && c != '"' && c != '\\'; });
}

bool OnlyLooks(std::string_view method) {
  constexpr std::array<std::string_view, 5> kLooks = {"Get", "List", "Watch", "Explain", "Validate"};
  return std::any_of(kLooks.begin(), kLooks.end(), [&](std::string_view verb) { return method.starts_with(verb); });
}

bool IsDenied(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::UNAUTHENTICATED ||
         status.error_code() == grpc::StatusCode::PERMISSION_DENIED;
}

std::string ReasonOrCode(const grpc::Status& status) {
  if (status.ok()) return "";
  google::rpc::Status details;
  if (details.ParseFromString(status.error_details())) {
    if (std::string reason = ReasonOf(details); !reason.empty()) return reason;
  }
  return absl::StatusCodeToString(static_cast<absl::StatusCode>(status.error_code()));
}

}  // namespace

CallTelemetry::CallTelemetry(Metrics& metrics, JsonLog* calls, JsonLog* audit, const std::vector<std::string>& services)
    : metrics_(metrics),
      calls_(calls),
      audit_(audit),
      other_methods_(metrics.MethodOf(kOtherMethods)),
      id_prefix_(RandomHex(4) + "-") {
  for (const std::string& name : services) {
    const auto* service = google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(name);
    for (int i = 0; i < service->method_count(); ++i) {
      const google::protobuf::MethodDescriptor& known = *service->method(i);
      const std::string path = "/" + service->full_name() + "/" + known.name();
      const std::string method = path.substr(kPackage.size());
      const bool is_unary = !known.client_streaming() && !known.server_streaming();
      methods_[path] = {method, &metrics.MethodOf(method), OnlyLooks(known.name()), is_unary};
      by_request_[known.input_type()] = &methods_[path];
    }
  }
}

CallTelemetry::Shard& CallTelemetry::ShardOf(const grpc::ServerContextBase& context) {
  return shards_[(reinterpret_cast<std::uintptr_t>(&context) >> 6) % shards_.size()];
}

const CallTelemetry::Method* CallTelemetry::Find(std::string_view path) const {
  const auto known = methods_.find(path);
  return known == methods_.end() ? nullptr : &known->second;
}

bool CallTelemetry::MayLog(const Method* method, const grpc::Status* status) const {
  if (method == nullptr) return false;
  if (calls_ != nullptr) return true;
  return audit_ != nullptr && (!method->only_looks || status == nullptr || IsDenied(*status));
}

std::string CallTelemetry::GivenRequestId(const Metadata& metadata) {
  const auto given = metadata.find(kRequestId);
  if (given == metadata.end() || !IsRequestId(given->second)) return "";
  return {given->second.data(), given->second.size()};
}

std::string CallTelemetry::NextRequestId() { return id_prefix_ + std::to_string(++next_id_); }

void CallTelemetry::NoteCaller(const grpc::ServerContextBase& context, const std::string& caller) {
  if (!logs()) return;
  Shard& shard = ShardOf(context);
  const std::lock_guard lock(shard.mutex);
  shard.notes[&context].caller = caller;
}

void CallTelemetry::NoteResource(const grpc::ServerContextBase& context, const std::string& name) {
  if (!logs()) return;
  Shard& shard = ShardOf(context);
  const std::lock_guard lock(shard.mutex);
  shard.notes[&context].resource = name;
}

CallTelemetry::Notes CallTelemetry::TakeNotes(const grpc::ServerContextBase& context) {
  if (!logs()) return {};
  Shard& shard = ShardOf(context);
  const std::lock_guard lock(shard.mutex);
  auto node = shard.notes.extract(&context);
  return node ? std::move(node.mapped()) : Notes{};
}

void CallTelemetry::Ended(const grpc::ServerContextBase& context, const Call& call, const Notes& notes) {
  const auto code = static_cast<absl::StatusCode>(call.status.error_code());
  const std::string reason = ReasonOrCode(call.status);
  const bool ours = call.method != nullptr;
  metrics_.CallEnded(ours ? *call.method->metrics : other_methods_, code, ours ? reason : "", call.seconds,
                     static_cast<double>(call.sent_bytes));
  if (!ours || !logs()) return;
  const bool changes = !call.method->only_looks && (!notes.resource.empty() || !call.status.ok());
  const bool audited = audit_ != nullptr && (changes || IsDenied(call.status));
  if (!audited && calls_ == nullptr) return;
  JsonLog::Line line;
  line["request"] = call.request_id;
  line["caller"] = notes.caller;
  line["method"] = call.method->name;
  if (!notes.resource.empty()) line["resource"] = notes.resource;
  if (!notes.grantee.empty()) line["grantee"] = notes.grantee;
  line["code"] = absl::StatusCodeToString(code);
  if (!reason.empty()) line["reason"] = reason;
  line["peer"] = context.peer();
  if (audited) audit_->Write(line);
  line["seconds"] = call.seconds;
  line["sent_bytes"] = call.sent_bytes;
  if (calls_ != nullptr) calls_->Write(line);
}

}  // namespace flatlight
