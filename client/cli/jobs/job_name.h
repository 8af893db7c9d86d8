// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_JOBS_JOB_NAME_H_
#define FLATLIGHT_CLIENT_CLI_JOBS_JOB_NAME_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

// A random UUID (RFC 4122, version 4).
std::string NewUuid();

// What has a name of the form PREFIX{uuid}.
struct NameKind {
  const char* prefix;
  const char* noun;
  const char* list;  // The command that lists them.
};
inline constexpr NameKind kJobNames = {"jobs/", "job", "flatlight jobs"};
inline constexpr NameKind kRoomNames = {"rooms/", "room", "flatlight room list"};

// A whole name from a whole name, from a UUID, or (through `all`, every name) from the beginning of one. Errors end
// with ExitCode::kUsage.
absl::StatusOr<std::string> MatchName(const NameKind& kind, const std::string& text,
                                      const std::vector<std::string>& all);
// Whether `text` is a whole name, so that nobody needs to be asked.
bool IsWholeName(const NameKind& kind, const std::string& text);

absl::StatusOr<std::string> MatchJobName(const std::string& text, const std::vector<std::string>& all);
bool IsWholeJobName(const std::string& text);

enum class WhoseJobs {
  kAll,    // The caller's own; for graders and above those of all.
  kOwn,    // The caller's own.
  kShared  // Those of others that are shared with the caller.
};
// Every one that the server keeps, newest first.
absl::StatusOr<std::vector<v1::Job>> ListJobs(Connection& connection, WhoseJobs whose = WhoseJobs::kAll);

// MatchJobName with the jobs that the caller may see, which are listed only if they are needed.
absl::StatusOr<std::string> ResolveJobName(Connection& connection, const std::string& text);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_JOBS_JOB_NAME_H_
