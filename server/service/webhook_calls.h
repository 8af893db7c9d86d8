// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_WEBHOOK_CALLS_H_
#define FLATLIGHT_SERVER_SERVICE_WEBHOOK_CALLS_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "flatlight/v1/render_service.pb.h"
#include "flatlight/v1/server_service.pb.h"
#include "server/service/backend.h"
#include "server/store/job.h"

namespace flatlight {

// Whether a job of the caller may have this webhook: WebhookRules::Check, and RESOURCE_EXHAUSTED with
// TOO_MANY_WEBHOOKS, TOO_MANY_OWN_WEBHOOKS.
absl::Status CheckWebhook(Backend& backend, const Caller& caller, const std::string& url);
// ServerService.GetWebhookSecret.
absl::StatusOr<v1::GetWebhookSecretResponse> GetWebhookSecret(Backend& backend, const Caller& caller);
// ServerService.RotateWebhookSecret.
absl::StatusOr<v1::GetWebhookSecretResponse> RotateWebhookSecret(Backend& backend, const Caller& caller,
                                                                 const v1::RotateWebhookSecretRequest& request);

// What is sent at the end of a job: JSON, and nothing that opens anything.
std::string WebhookBody(const JobRecord& job, const std::string& build);
// Job.webhook, if the job has one.
absl::Status TellWebhook(WebhookOutbox& webhooks, const JobSpec& spec, v1::Job& job);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_WEBHOOK_CALLS_H_
