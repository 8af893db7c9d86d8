// SPDX-License-Identifier: Apache-2.0
#include "server/webhook/webhook_rules.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>

#include <string>
#include <vector>

#include "server/store/error.h"
#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using testing::IsOk;

WebhookRules Rules(const std::vector<std::string>& hosts) {
  WebhookRules rules;
  for (const std::string& host : hosts) EXPECT_THAT(rules.Allow(host), IsOk()) << host;
  return rules;
}

bool AllowsAddress(const WebhookRules& rules, const std::string& address, int port) {
  sockaddr_in v4{};
  v4.sin_family = AF_INET;
  v4.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &v4.sin_addr) == 1) {
    return rules.AllowsAddress(reinterpret_cast<const sockaddr&>(v4));
  }
  sockaddr_in6 v6{};
  v6.sin6_family = AF_INET6;
  v6.sin6_port = htons(static_cast<std::uint16_t>(port));
  EXPECT_EQ(inet_pton(AF_INET6, address.c_str(), &v6.sin6_addr), 1) << address;
  return rules.AllowsAddress(reinterpret_cast<const sockaddr&>(v6));
}

TEST(WebhookRules, NobodyIsToldWhereNoHostIsAllowed) {
  const absl::Status refused = WebhookRules().Check("https://example.org/");
  EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(ReasonOf(refused), "WEBHOOKS_OFF");
  EXPECT_THAT(std::string(refused.message()), HasSubstr("--webhook-allow"));
}

TEST(WebhookRules, AHostIsAllowedAtItsPorts) {
  const WebhookRules rules = Rules({"hooks.example.org", "Grader.example.org:8443", "[2001:DB8::1]:80", "10.1.2.3"});
  for (const char* url :
       {"https://hooks.example.org/a?b=c", "http://hooks.example.org", "https://hooks.example.org:443/",
        "https://HOOKS.Example.org/", "http://grader.example.org:8443/x", "https://grader.example.org:8443",
        "http://[2001:db8:0:0::1]/", "http://10.1.2.3/", "http://0x0a.1.2.3/"}) {
    EXPECT_THAT(rules.Check(url), IsOk()) << url;
  }
  for (const char* url : {"https://example.org/",
                          "https://evil-hooks.example.org/",
                          "https://hooks.example.org.evil.org/",
                          "https://hooks.example.org:8443/",
                          "http://hooks.example.org:443/",
                          "https://grader.example.org/",
                          "https://hooks.example.org@evil.org/",
                          "https://user:pass@hooks.example.org/",
                          "https://evil.org#hooks.example.org",
                          "https://hooks.example.org/#part",
                          "ftp://hooks.example.org/",
                          "file:///etc/passwd",
                          "gopher://hooks.example.org/",
                          "hooks.example.org",
                          "//hooks.example.org/",
                          "",
                          "https://",
                          "https://hooks.example.org\\@evil.org/",
                          "https://hooks.example.org/ x",
                          "https://hooks.example.org/\n",
                          "https://hooks.example.org/\xc3\xa4",
                          "http://10.1.2.4/",
                          "http://[2001:db8::2]/",
                          "http://[2001:db8::1%25lo]/"}) {
    const absl::Status refused = rules.Check(url);
    EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument) << url;
    EXPECT_EQ(ReasonOf(refused), "BAD_WEBHOOK") << url;
  }
  EXPECT_THAT(rules.Check("https://hooks.example.org/" + std::string(2000, 'a')), IsOk());
  EXPECT_FALSE(rules.Check("https://hooks.example.org/" + std::string(2048, 'a')).ok());
  EXPECT_THAT(std::string(rules.Check("https://example.org/").message()),
              HasSubstr("allowed: hooks.example.org, Grader.example.org:8443"));
}

TEST(WebhookRules, OnlyHostsCanBeAllowed) {
  for (const char* text : {"", "*", "*.example.org", "https://example.org", "example.org/path", "example.org:0",
                           "example.org:70000", "example.org:x", "user@example.org", "a b", "[::1"}) {
    WebhookRules rules;
    EXPECT_EQ(rules.Allow(text).code(), absl::StatusCode::kInvalidArgument) << text;
    EXPECT_TRUE(rules.hosts().empty()) << text;
  }
}

TEST(WebhookRules, ANameMayStandForAPublicAddressAlone) {
  const WebhookRules rules = Rules({"hooks.example.org"});
  for (const char* address : {"93.184.216.34", "8.8.8.8", "172.15.0.1", "172.32.0.1", "100.63.0.1", "11.0.0.1",
                              "2606:2800:220:1:248:1893:25c8:1946", "2001:4860:4860::8888"}) {
    EXPECT_TRUE(AllowsAddress(rules, address, 443)) << address;
  }
  for (const char* address : {"127.0.0.1",
                              "127.8.8.8",
                              "0.0.0.0",
                              "10.0.0.1",
                              "172.16.0.1",
                              "172.31.255.255",
                              "192.168.1.1",
                              "169.254.169.254",
                              "100.64.0.1",
                              "224.0.0.1",
                              "255.255.255.255",
                              "192.0.2.1",
                              "198.18.0.1",
                              "::1",
                              "::",
                              "fe80::1",
                              "fc00::1",
                              "fd12::1",
                              "ff02::1",
                              "::ffff:127.0.0.1",
                              "::ffff:8.8.8.8",
                              "64:ff9b::a00:1",
                              "2002:a00:1::",
                              "2001:0:a00:1::",
                              "2001:db8::1"}) {
    EXPECT_FALSE(AllowsAddress(rules, address, 443)) << address;
  }
}

TEST(WebhookRules, APrivateAddressIsAllowedWhereItIsNamed) {
  const WebhookRules rules = Rules({"grader.lab", "10.1.2.3", "127.0.0.1:8080", "[fd12::1]:9000"});
  EXPECT_TRUE(AllowsAddress(rules, "10.1.2.3", 80));
  EXPECT_TRUE(AllowsAddress(rules, "10.1.2.3", 443));
  EXPECT_FALSE(AllowsAddress(rules, "10.1.2.3", 22));
  EXPECT_FALSE(AllowsAddress(rules, "10.1.2.4", 80));
  EXPECT_TRUE(AllowsAddress(rules, "127.0.0.1", 8080));
  EXPECT_FALSE(AllowsAddress(rules, "127.0.0.1", 80));
  EXPECT_TRUE(AllowsAddress(rules, "fd12::1", 9000));
  EXPECT_FALSE(AllowsAddress(rules, "fd12::2", 9000));
}

TEST(WebhookRules, TheHostOfAUrlIsTold) {
  EXPECT_EQ(WebhookHost("https://Hooks.example.org:8443/secret?token=1"), "hooks.example.org");
  EXPECT_EQ(WebhookHost("nonsense"), "");
}

}  // namespace
}  // namespace flatlight
