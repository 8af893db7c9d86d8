// SPDX-License-Identifier: Apache-2.0
#include "server/service/webhook_calls.h"

#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include "google/protobuf/util/time_util.h"
#include "nlohmann/json.hpp"
#include "server/service/job_convert.h"
#include "server/service/status_convert.h"
#include "server/store/error.h"
#include "server/webhook/webhook_signature.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxOpen = 10'000;  // That wait for their job, or to be taken.
constexpr std::size_t kMaxOpenOfOne = 1000;
constexpr std::chrono::milliseconds kTryAgain{60'000};
// s, of an earlier secret: longer than a message is tried again; and at most.
constexpr double kKeepSecrets = 24 * 3600;
constexpr double kMostKeepSecrets = 30 * 24 * 3600;

std::string Rfc3339(WallTime time) {
  google::protobuf::Timestamp timestamp;
  SetTime(time, timestamp);
  return google::protobuf::util::TimeUtil::ToString(timestamp);
}

const char* TypeOf(JobPhase phase) {
  return phase == JobPhase::kSucceeded ? "job.succeeded" : phase == JobPhase::kFailed ? "job.failed" : "job.cancelled";
}

v1::Webhook::State StateOf(const WebhookState& state) {
  if (state.end_time) return state.delivered ? v1::Webhook::DELIVERED : v1::Webhook::GIVEN_UP;
  return state.next_attempt ? v1::Webhook::SENDING : v1::Webhook::WAITING;
}

absl::StatusOr<v1::GetWebhookSecretResponse> SecretsToProto(const Backend& backend, const Caller& caller,
                                                            const absl::StatusOr<std::vector<SecretTerm>>& terms) {
  if (!terms.ok()) return terms.status();
  v1::GetWebhookSecretResponse response;
  for (const SecretTerm& term : *terms) {
    const std::string secret = WebhookSecretText(WebhookSecret(backend.webhook_key, caller.name, term.generation));
    if (!term.expire_time) {
      response.set_secret(secret);
      continue;
    }
    v1::EarlierWebhookSecret& earlier = *response.add_earlier();
    earlier.set_secret(secret);
    SetTime(*term.expire_time, *earlier.mutable_expire_time());
  }
  return response;
}

}  // namespace

absl::Status CheckWebhook(Backend& backend, const Caller& caller, const std::string& url) {
  if (absl::Status allowed = backend.webhook_rules.Check(url); !allowed.ok()) return allowed;
  const auto own = backend.webhooks.OpenOf(caller.name);
  if (!own.ok()) return own.status();
  if (*own >= kMaxOpenOfOne) {
    return MakeQuotaError(
        "TOO_MANY_OWN_WEBHOOKS", "max_webhooks_per_user",
        std::to_string(*own) + " of your webhooks have not been delivered; allowed: " + std::to_string(kMaxOpenOfOne),
        kTryAgain, QuotaUse{static_cast<double>(*own), static_cast<double>(kMaxOpenOfOne)});
  }
  const auto all = backend.webhooks.OpenOf(std::nullopt);
  if (!all.ok()) return all.status();
  if (*all < kMaxOpen) return absl::OkStatus();
  return MakeQuotaError(
      "TOO_MANY_WEBHOOKS", "max_webhooks",
      std::to_string(*all) + " webhooks have not been delivered; allowed: " + std::to_string(kMaxOpen), kTryAgain);
}

absl::StatusOr<v1::GetWebhookSecretResponse> GetWebhookSecret(Backend& backend, const Caller& caller) {
  return SecretsToProto(backend, caller, backend.webhooks.SecretsOf(caller.name, std::chrono::system_clock::now()));
}

absl::StatusOr<v1::GetWebhookSecretResponse> RotateWebhookSecret(Backend& backend, const Caller& caller,
                                                                 const v1::RotateWebhookSecretRequest& request) {
  const double seconds = request.has_keep_earlier_seconds() ? request.keep_earlier_seconds() : kKeepSecrets;
  if (!(seconds >= 0 && seconds <= kMostKeepSecrets)) {
    return MakeFieldError("keep_earlier_seconds",
                          std::to_string(seconds) + "; allowed: 0 to " + std::to_string(std::lround(kMostKeepSecrets)));
  }
  const auto keep = std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(seconds));
  return SecretsToProto(backend, caller,
                        backend.webhooks.RotateSecretOf(caller.name, std::chrono::system_clock::now(), keep));
}

std::string WebhookBody(const JobRecord& job, const std::string& build) {
  const JobSpec& spec = *job.spec;
  const JobState& state = *job.state;
  const v1::Job proto = JobToProto(spec, state, JobView::kChanging);
  nlohmann::ordered_json data;
  data["job"] = spec.id.Name();
  data["state"] = v1::Job::State_Name(proto.state());
  if (state.end_reason) data["endReason"] = v1::EndReason_Name(proto.end_reason());
  data["scene"] = spec.scene->name;
  data["owner"] = spec.owner;
  data["createTime"] = Rfc3339(spec.create_time);
  data["endTime"] = Rfc3339(*state.end_time);
  data["elapsedSeconds"] = state.elapsed_seconds;
  if (!state.error.ok()) data["error"] = std::string(state.error.message());
  data["build"] = build;
  // What to call, and with what.
  data["links"]["GetJob"]["name"] = spec.id.Name();
  if (state.field != nullptr) data["links"]["GetResult"]["name"] = spec.id.Name();
  nlohmann::ordered_json event;
  event["id"] = WebhookId(spec.id.uuid());
  event["type"] = TypeOf(state.phase);
  event["timestamp"] = Rfc3339(*state.end_time);
  event["data"] = std::move(data);
  return event.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

absl::Status TellWebhook(WebhookOutbox& webhooks, const JobSpec& spec, v1::Job& job) {
  if (spec.webhook.empty()) return absl::OkStatus();
  const auto found = webhooks.Of(spec.id);
  if (!found.ok()) return found.status();
  v1::Webhook& webhook = *job.mutable_webhook();
  webhook.set_url(spec.webhook);
  if (!*found) return absl::OkStatus();
  const WebhookState& state = **found;
  webhook.set_state(StateOf(state));
  webhook.set_attempts(state.attempts);
  webhook.set_error(state.error);
  if (state.next_attempt && state.attempts > 0) SetTime(*state.next_attempt, *webhook.mutable_next_attempt_time());
  if (state.end_time) SetTime(*state.end_time, *webhook.mutable_end_time());
  return absl::OkStatus();
}

}  // namespace flatlight
