// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/server_address.h"

#include <gtest/gtest.h>

namespace flatlight {
namespace {

std::string Target(const std::string& text) {
  const auto address = ParseServerAddress(text, "--server");
  return address.ok() ? address->target : "refused";
}

TEST(ServerAddress, AddressesNeedNoResolver) {
  EXPECT_EQ(Target("127.0.0.1:7000"), "ipv4:127.0.0.1:7000");
  EXPECT_EQ(Target("[::1]:7000"), "ipv6:[::1]:7000");
  EXPECT_EQ(Target("farm.example.org:80"), "dns:///farm.example.org:80");
  EXPECT_EQ(Target("unix:/run/flatlight"), "unix:/run/flatlight");
}

TEST(ServerAddress, LoopbackUsesNoProxy) {
  for (const char* text : {"127.0.0.1:1", "127.1.2.3:1", "[::1]:1", "localhost:1", "unix:/x"})
    EXPECT_TRUE(ParseServerAddress(text, "")->local) << text;
  EXPECT_FALSE(ParseServerAddress("10.0.0.1:1", "")->local);
}

TEST(ServerAddress, WhatIsNoneIsRefused) {
  for (const char* text : {"", "host", ":1", "host:", "host:0", "host:65536", "host:x", "host:1x", "::1:7000",
                           "[host]:1", "http://host:1", "unix:", "[]:1", "a:b:1"})
    EXPECT_EQ(Target(text), "refused") << text;
  EXPECT_EQ(Target("unix:/" + std::string(107, 'x')), "refused");
  EXPECT_NE(Target("unix:/" + std::string(106, 'x')), "refused");
}

}  // namespace
}  // namespace flatlight
