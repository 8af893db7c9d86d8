// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/commands.h"
#include "client/cli/commands/quota_text.h"
#include "client/cli/commands/session.h"
#include "client/cli/formats/json_text.h"

namespace flatlight {

CommandResult ShowQuotas(const CommandLine& line, Interruption& interruption) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  const v1::GetCapabilitiesResponse& capabilities = (*session)->connection().capabilities();
  if (!capabilities.has_quotas()) {
    return absl::UnimplementedError("the server, " + capabilities.version() + ", is too old to tell of quotas");
  }
  return Answer(line.json ? ToJson(capabilities.quotas()) : QuotaText(capabilities.quotas()));
}

}  // namespace flatlight
