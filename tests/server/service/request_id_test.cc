// SPDX-License-Identifier: Apache-2.0
// The metadata x-request-id of answers: what names a call in the logs.
#include <gtest/gtest.h>

#include <string>

#include "server/service/server.h"
#include "tests/support/loopback/loopback_server.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

using testing::LoopbackServer;
using testing::TestContext;

constexpr char kRequestId[] = "x-request-id";

// Of an answer; empty: it came without.
std::string IdOf(const grpc::ClientContext& context) {
  const auto& metadata = context.GetServerInitialMetadata();
  const auto found = metadata.find(kRequestId);
  return found == metadata.end() ? "" : std::string(found->second.data(), found->second.size());
}

std::string IdOfLook(LoopbackServer& server, const std::string& given = "") {
  TestContext context;
  if (!given.empty()) context.AddMetadata(kRequestId, given);
  v1::GetCapabilitiesResponse response;
  const grpc::Status status = server.info().GetCapabilities(&context, {}, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_FALSE(response.methods().empty());
  return IdOf(context);
}

std::string IdOfChange(LoopbackServer& server) {
  TestContext context;
  v1::Job job;
  EXPECT_FALSE(server.render().CreateJob(&context, {}, &job).ok()) << "it has no scene";
  return IdOf(context);
}

TEST(RequestId, TheCallersOwnIsSentBackByEveryServer) {
  LoopbackServer server;
  EXPECT_EQ(IdOfLook(server, "mine-7"), "mine-7");
  EXPECT_EQ(IdOfLook(server), "");
  EXPECT_EQ(IdOfChange(server), "") << "there is no log";
}

TEST(RequestId, WithAnAuditLogChangesHaveOne) {
  const testing::TemporaryFolder folder;
  ServerOptions options;
  options.data = folder.path();
  LoopbackServer server(options);
  EXPECT_EQ(IdOfLook(server), "");
  EXPECT_EQ(IdOfLook(server, "mine-7"), "mine-7");
  EXPECT_NE(IdOfChange(server), "");
}

TEST(RequestId, WithAnAuditLogWhatIsDeniedHasOne) {
  const testing::TemporaryFolder folder;
  ServerOptions options;
  options.data = folder.path();
  options.token = "secret";
  LoopbackServer server(options);
  TestContext context;
  v1::GetCapabilitiesResponse response;
  EXPECT_EQ(server.info().GetCapabilities(&context, {}, &response).error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_NE(IdOf(context), "");
}

TEST(RequestId, WithALogOfCallsEachHasItsOwn) {
  const testing::TemporaryFolder folder;
  ServerOptions options;
  options.log = folder.path() + "/calls.jsonl";
  LoopbackServer server(options);
  const std::string first = IdOfLook(server);
  EXPECT_NE(first, "");
  EXPECT_NE(IdOfLook(server), first);
  EXPECT_NE(IdOfChange(server), "");
}

}  // namespace
}  // namespace flatlight
