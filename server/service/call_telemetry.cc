// SPDX-License-Identifier: Apache-2.0
#include "server/service/call_telemetry.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "google/protobuf/descriptor.h"
#include "google/rpc/status.pb.h"
#include "server/service/status_convert.h"
#include "server/store/random_bytes.h"

namespace flatlight {
namespace {

using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::InterceptorBatchMethods;

constexpr char kRequestId[] = "x-request-id";
constexpr std::size_t kMaxRequestIdBytes = 128;
constexpr std::string_view kPackage = "/flatlight.v1.";
constexpr char kOtherMethods[] = "other";  // Health, reflection, and names that strangers think of.

bool IsRequestId(const grpc::string_ref& text) {
  return !text.empty() && text.size() <= kMaxRequestIdBytes &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~' && c != '"' && c != '\\'; });
}

std::string ReasonOrCode(const grpc::Status& status) {
  if (status.ok()) return "";
  google::rpc::Status details;
  if (details.ParseFromString(status.error_details())) {
    if (std::string reason = ReasonOf(details); !reason.empty()) return reason;
  }
  return absl::StatusCodeToString(static_cast<absl::StatusCode>(status.error_code()));
}

class CallInterceptor final : public grpc::experimental::Interceptor {
 public:
  CallInterceptor(CallTelemetry& telemetry, grpc::experimental::ServerRpcInfo& info)
      : telemetry_(telemetry), info_(info), start_(std::chrono::steady_clock::now()) {
    call_.method = telemetry.Find(info.method());
  }

  void Intercept(InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::POST_RECV_INITIAL_METADATA)) {
      const auto* metadata = methods->GetRecvInitialMetadata();
      const auto given = metadata == nullptr ? std::multimap<grpc::string_ref, grpc::string_ref>::const_iterator()
                                             : metadata->find(kRequestId);
      if (metadata != nullptr && given != metadata->end() && IsRequestId(given->second)) {
        call_.request_id.assign(given->second.data(), given->second.size());
      }
    }
    const bool ends = methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS);
    if (ends) call_.status = methods->GetSendStatus();
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      NameCall(ends);
      auto* metadata = methods->GetSendInitialMetadata();
      if (metadata != nullptr && !call_.request_id.empty()) metadata->emplace(kRequestId, call_.request_id);
    }
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_MESSAGE)) {
      if (auto* bytes = methods->GetSerializedSendMessage(); bytes != nullptr) {
        call_.sent_bytes += bytes->Length();
      }
    }
    if (ends) End();
    methods->Proceed();
  }

 private:
  void NameCall(bool ends) {
    if (!call_.request_id.empty() || !telemetry_.MayLog(call_.method, ends ? &call_.status : nullptr)) return;
    call_.request_id = telemetry_.NextRequestId();
  }

  void End() {
    call_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    NameCall(true);
    telemetry_.Ended(info_.server_context(), call_);
  }

  CallTelemetry& telemetry_;
  grpc::experimental::ServerRpcInfo& info_;
  const std::chrono::steady_clock::time_point start_;
  CallTelemetry::Call call_;
};

class Factory final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  explicit Factory(CallTelemetry& telemetry) : telemetry_(telemetry) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(grpc::experimental::ServerRpcInfo* info) override {
    return new CallInterceptor(telemetry_, *info);
  }

 private:
  CallTelemetry& telemetry_;
};

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
      const std::string path = "/" + service->full_name() + "/" + service->method(i)->name();
      const std::string method = path.substr(kPackage.size());
      methods_[path] = {method, &metrics.MethodOf(method), OnlyLooks(service->method(i)->name())};
    }
  }
}

CallTelemetry::Shard& CallTelemetry::ShardOf(const grpc::ServerContextBase* context) {
  return shards_[(reinterpret_cast<std::uintptr_t>(context) >> 6) % shards_.size()];
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

bool CallTelemetry::OnlyLooks(std::string_view name) {
  constexpr std::array<std::string_view, 5> kLooks = {"Get", "List", "Watch", "Explain", "Validate"};
  return std::any_of(kLooks.begin(), kLooks.end(), [&](std::string_view verb) { return name.starts_with(verb); });
}

void CallTelemetry::NoteCaller(const grpc::ServerContextBase& context, const std::string& caller) {
  if (!logs()) return;
  Shard& shard = ShardOf(&context);
  const std::lock_guard lock(shard.mutex);
  shard.notes[&context].caller = caller;
}

void CallTelemetry::NoteGrantee(const grpc::ServerContextBase& context, const std::string& grantee) {
  if (!logs()) return;
  Shard& shard = ShardOf(&context);
  const std::lock_guard lock(shard.mutex);
  shard.notes[&context].grantee = grantee;
}

void CallTelemetry::NoteResource(const grpc::ServerContextBase& context, const std::string& name) {
  if (!logs()) return;
  Shard& shard = ShardOf(&context);
  const std::lock_guard lock(shard.mutex);
  shard.notes[&context].resource = name;
}

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> CallTelemetry::MakeFactory() {
  return std::make_unique<Factory>(*this);
}

std::string CallTelemetry::NextRequestId() { return id_prefix_ + std::to_string(++next_id_); }

void CallTelemetry::Ended(const grpc::ServerContextBase* context, const Call& call) {
  const auto code = static_cast<absl::StatusCode>(call.status.error_code());
  const std::string reason = ReasonOrCode(call.status);
  const bool ours = call.method != nullptr;
  metrics_.CallEnded(ours ? *call.method->metrics : other_methods_, code, ours ? reason : "", call.seconds,
                     static_cast<double>(call.sent_bytes));
  if (!logs()) return;
  Notes notes;
  {
    Shard& shard = ShardOf(context);
    const std::lock_guard lock(shard.mutex);
    if (auto node = shard.notes.extract(context)) notes = std::move(node.mapped());
  }
  if (!ours) return;
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
  line["peer"] = context->peer();
  if (audited) audit_->Write(line);
  line["seconds"] = call.seconds;
  line["sent_bytes"] = call.sent_bytes;
  if (calls_ != nullptr) calls_->Write(line);
}

}  // namespace flatlight
