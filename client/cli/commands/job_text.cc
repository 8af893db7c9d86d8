// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/job_text.h"

#include <algorithm>

#include "client/cli/commands/plan_text.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/formats/timestamp.h"
#include "client/cli/progress/progress_line.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"
#include "google/protobuf/util/time_util.h"

namespace flatlight {
namespace {

using google::protobuf::util::TimeUtil;

constexpr char kAnonymous[] = "anonymous";  // Everybody, at a server without users.

std::string Uuid(const v1::Job& job) { return job.name().substr(job.name().find('/') + 1); }

std::string WebhookText(const v1::Webhook& webhook) {
  std::string text = Printable(webhook.url()) + ", " + OptionName(webhook.state());
  if (webhook.has_end_time()) text += " " + TimeUtil::ToString(webhook.end_time());
  if (!webhook.error().empty()) {
    text += " after " + std::to_string(webhook.attempts()) + (webhook.attempts() == 1 ? " attempt" : " attempts");
    text += ", the last one: " + Printable(webhook.error());
  }
  if (webhook.has_next_attempt_time()) text += "; the next one " + TimeUtil::ToString(webhook.next_attempt_time());
  return text;
}

}  // namespace

std::string JobListText(const std::vector<v1::Job>& jobs, double now, WhoseJobs whose) {
  const bool shared = whose == WhoseJobs::kShared;
  if (jobs.empty()) return shared ? "no jobs are shared with you\n" : "no jobs\n";
  std::vector<std::vector<std::string>> rows = {{"JOB", "STATE", "DONE", "METHOD", "AGE", "SCENE"}};
  if (shared) rows.front().insert(rows.front().begin() + 1, "OWNER");
  for (const v1::Job& job : jobs) {
    rows.push_back({Uuid(job), OptionName(job.state()),
                    std::to_string(static_cast<int>(100 * job.progress().fraction())) + " %",
                    OptionName(job.plan().settings().method()),
                    FormatSeconds(std::max(0.0, now - SecondsOf(job.create_time()))), Printable(job.scene())});
    if (shared) rows.back().insert(rows.back().begin() + 1, Printable(job.owner()));
  }
  return FormatTable(rows);
}

std::string SharesText(const google::protobuf::RepeatedPtrField<v1::Share>& shares) {
  std::string text;
  for (const v1::Share& share : shares)
    text += (text.empty() ? "" : ", ") + Printable(share.grantee()) + " (" + OptionName(share.access()) + ")";
  return text.empty() ? "nobody" : text;
}

std::string JobText(const v1::Job& job) {
  std::vector<std::vector<std::string>> rows = {{"job", job.name()}, {"scene", Printable(job.scene())}};
  const std::string end = job.end_reason() == 0 ? "" : ", " + OptionName(job.end_reason());
  rows.push_back({"state", OptionName(job.state()) + end});
  if (!job.owner().empty() && job.owner() != kAnonymous) rows.push_back({"owner", Printable(job.owner())});
  if (!job.shares().empty()) rows.push_back({"shared", SharesText(job.shares())});
  if (job.has_webhook()) rows.push_back({"webhook", WebhookText(job.webhook())});
  if (job.has_error()) rows.push_back({"error", Printable(job.error().message())});
  rows.push_back({"progress", ProgressLine(job, 0)});
  if (job.progress().samples() > 0)
    rows.push_back({"samples", FormatExactly(job.progress().samples()) + " paths a point"});
  if (job.progress().rays() > 0) rows.push_back({"rays", FormatCount(job.progress().rays())});
  rows.push_back({"time", FormatSeconds(job.progress().elapsed_seconds())});
  rows.push_back({"created", TimeUtil::ToString(job.create_time())});
  if (job.has_start_time()) rows.push_back({"started", TimeUtil::ToString(job.start_time())});
  if (job.has_end_time()) rows.push_back({"ended", TimeUtil::ToString(job.end_time())});
  if (job.has_expire_time()) rows.push_back({"kept until", TimeUtil::ToString(job.expire_time())});
  return FormatTable(rows) + '\n' + PlanText(job.plan());
}

}  // namespace flatlight
