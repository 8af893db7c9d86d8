// SPDX-License-Identifier: Apache-2.0
// Webhooks in a database, as part of its owner's transactions: so that a job's end and the wish to tell of it are
// written together, or neither is.
#ifndef FLATLIGHT_SERVER_STORE_WEBHOOK_TABLE_H_
#define FLATLIGHT_SERVER_STORE_WEBHOOK_TABLE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/database.h"
#include "server/store/job_id.h"

namespace flatlight {

// `url` is to be told of the end of a job. Once a job.
absl::Status InsertWebhook(Database& database, const JobId& job, const std::string& owner, const std::string& url);
// The job has ended: `body` is to be sent at once. Returns whether it has a webhook.
absl::StatusOr<bool> MakeWebhookDue(Database& database, const JobId& job, const std::string& body);
// The job is gone. What is due is sent nevertheless. (Of a job in the table `jobs` a trigger does the same.)
absl::Status DetachWebhook(Database& database, const JobId& job);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_WEBHOOK_TABLE_H_
