// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/commands/session.h"
#include "google/protobuf/util/time_util.h"

namespace flatlight {
namespace {

constexpr std::size_t kShownOfEarlier = 12;  // Bytes: enough to tell one from another.

}  // namespace

CommandResult ShowWebhookSecret(const CommandLine& line, Interruption& interruption) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  Connection& connection = (*session)->connection();
  v1::RotateWebhookSecretRequest rotation;
  if (line.keep_seconds) rotation.set_keep_earlier_seconds(*line.keep_seconds);
  const auto response =
      line.rotate ? connection.Ask(connection.server(), &v1::ServerService::Stub::RotateWebhookSecret, rotation)
                  : connection.Ask(connection.server(), &v1::ServerService::Stub::GetWebhookSecret,
                                   v1::GetWebhookSecretRequest());
  if (!response.ok()) return response.status();
  for (const v1::EarlierWebhookSecret& earlier : response->earlier()) {
    std::fprintf(stderr, "flatlight: messages are signed with %s... too, until %s\n",
                 earlier.secret().substr(0, kShownOfEarlier).c_str(),
                 google::protobuf::util::TimeUtil::ToString(earlier.expire_time()).c_str());
  }
  return Answer(response->secret() + '\n');
}

}  // namespace flatlight
