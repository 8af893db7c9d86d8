// SPDX-License-Identifier: Apache-2.0
#include "client/cli/jobs/job_name.h"

#include <sys/random.h>

#include <array>
#include <set>

#include "absl/strings/escaping.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

constexpr std::size_t kUuidLength = 36;

bool IsUuidBeginning(const std::string& text) {
  if (text.empty() || text.size() > kUuidLength) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
    const bool digit = (text[i] >= '0' && text[i] <= '9') || (text[i] >= 'a' && text[i] <= 'f');
    if (dash ? text[i] != '-' : !digit) return false;
  }
  return true;
}

std::string WithoutPrefix(const NameKind& kind, const std::string& text) {
  const std::string prefix = kind.prefix;
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

}  // namespace

std::string NewUuid() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return "";
  bytes[6] = static_cast<unsigned char>((bytes[6] & 0x0F) | 0x40);
  bytes[8] = static_cast<unsigned char>((bytes[8] & 0x3F) | 0x80);
  std::string uuid = absl::BytesToHexString({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  for (const std::size_t dash : {8, 13, 18, 23}) uuid.insert(dash, 1, '-');
  return uuid;
}

bool IsWholeName(const NameKind& kind, const std::string& text) {
  const std::string uuid = WithoutPrefix(kind, text);
  return uuid.size() == kUuidLength && IsUuidBeginning(uuid);
}

absl::StatusOr<std::string> MatchName(const NameKind& kind, const std::string& text,
                                      const std::vector<std::string>& all) {
  const std::string prefix = kind.prefix, noun = kind.noun;
  const std::string beginning = WithoutPrefix(kind, text);
  if (!IsUuidBeginning(beginning))
    return UsageError("'" + text + "' is not a " + noun + "; must be " + prefix +
                      "UUID, the UUID, or the beginning of one");
  if (beginning.size() == kUuidLength) return prefix + beginning;
  std::vector<std::string> matches;
  for (const std::string& name : all)
    if (name.starts_with(prefix + beginning)) matches.push_back(name);
  if (matches.size() == 1) return matches[0];
  if (matches.empty())
    return UsageError("no " + noun + " begins with '" + beginning + "'; `" + kind.list + "` lists them");
  std::string message = std::to_string(matches.size()) + " " + noun + "s begin with '" + beginning + "':";
  for (std::size_t i = 0; i < matches.size() && i < 5; ++i) message += " " + WithoutPrefix(kind, matches[i]);
  return UsageError(message + (matches.size() > 5 ? " ..." : ""));
}

absl::StatusOr<std::string> MatchJobName(const std::string& text, const std::vector<std::string>& all) {
  return MatchName(kJobNames, text, all);
}

bool IsWholeJobName(const std::string& text) { return IsWholeName(kJobNames, text); }

absl::StatusOr<std::vector<v1::Job>> ListJobs(Connection& connection, WhoseJobs whose) {
  std::vector<v1::Job> jobs;
  v1::ListJobsRequest request;
  request.set_page_size(1000);
  request.set_shared(whose == WhoseJobs::kShared);
  request.set_own(whose == WhoseJobs::kOwn);
  do {
    v1::ListJobsResponse response;
    const absl::Status status =
        connection.Call(connection.render(), &v1::RenderService::Stub::ListJobs, request, response);
    if (!status.ok()) return status;
    jobs.insert(jobs.end(), response.jobs().begin(), response.jobs().end());
    request.set_page_token(response.next_page_token());
  } while (!request.page_token().empty());
  return jobs;
}

absl::StatusOr<std::string> ResolveJobName(Connection& connection, const std::string& text) {
  std::set<std::string> names;
  if (!IsWholeJobName(text) && IsUuidBeginning(WithoutPrefix(kJobNames, text))) {
    for (const WhoseJobs whose : {WhoseJobs::kAll, WhoseJobs::kShared}) {
      const auto jobs = ListJobs(connection, whose);
      if (!jobs.ok()) return jobs.status();
      for (const v1::Job& job : *jobs) names.insert(job.name());
    }
  }
  return MatchJobName(text, {names.begin(), names.end()});
}

}  // namespace flatlight
