// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <string>
#include <utility>

#include "tests/support/loopback/loopback_server.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

using testing::LoopbackServer;
using testing::TestContext;

TEST(ConnectionLimits, LongMetadataAreRefused) {
  LoopbackServer server;
  for (const auto& [bytes, passes] : {std::pair(1000, true), std::pair(100'000, false)}) {
    TestContext context;
    context.AddMetadata("x-long", std::string(static_cast<std::size_t>(bytes), 'a'));
    v1::GetCapabilitiesResponse response;
    const grpc::Status status = server.info().GetCapabilities(&context, v1::GetCapabilitiesRequest(), &response);
    EXPECT_EQ(status.ok(), passes) << bytes << " " << status.error_message();
    if (!passes) {
      EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    }
  }
}

// As HPACK writes a header that is in no table.
std::string Header(const std::string& name, const std::string& value) {
  return std::string(1, '\0') + static_cast<char>(name.size()) + name + static_cast<char>(value.size()) + value;
}

// A peer that has greeted and begun a call, as HTTP/2 wants it, and then vanishes.
TEST(ConnectionLimits, WhoNoLongerAnswersHasGone) {
  const testing::TemporaryFolder folder;
  ServerOptions options;
  options.address = "unix:" + folder.path() + "/socket";
  options.keepalive = std::chrono::milliseconds(50);
  LoopbackServer server(options);
  const int peer = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = folder.path() + "/socket";
  std::memcpy(address.sun_path, path.c_str(), path.size());
  ASSERT_EQ(connect(peer, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  const std::string headers = Header(":method", "POST") + Header(":scheme", "http") +
                              Header(":authority", "localhost") +
                              Header(":path", "/flatlight.v1.RenderService/WatchJob") +
                              Header("content-type", "application/grpc") + Header("te", "trailers");
  const std::string greeting = std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\x04\0\0\0\0\0", 33) +
                               std::string({'\0', '\0', static_cast<char>(headers.size()), 1, 4, 0, 0, 0, 1}) + headers;
  ASSERT_EQ(write(peer, greeting.data(), greeting.size()), static_cast<ssize_t>(greeting.size()));
  bool closed = false;
  std::array<char, 4096> received;
  for (pollfd ready{peer, POLLIN, 0}; !closed && poll(&ready, 1, 30'000) == 1;) {
    closed = read(peer, received.data(), received.size()) <= 0;
  }
  EXPECT_TRUE(closed);
  close(peer);
}

}  // namespace
}  // namespace flatlight
