// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/commands.h"
#include "client/cli/commands/session.h"

namespace flatlight {

CommandResult ShowWebhookSecret(const CommandLine& line, Interruption& interruption) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  const auto response =
      connection.Ask(connection.server(), &v1::ServerService::Stub::GetWebhookSecret, v1::GetWebhookSecretRequest());
  if (!response.ok()) return response.status();
  return Answer(response->secret() + '\n');
}

}  // namespace flatlight
