// SPDX-License-Identifier: Apache-2.0
#include "server/webhook/webhook_rules.h"

#include <arpa/inet.h>
#include <curl/curl.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_join.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxUrlBytes = 2048;
constexpr int kHttpPort = 80;
constexpr int kHttpsPort = 443;

struct CleanUpUrl {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};
using Url = std::unique_ptr<CURLU, CleanUpUrl>;

// By the parser of the library that connects: what is checked is where it goes.
Url Parse(const std::string& text) {
  Url url(curl_url());
  if (url == nullptr || curl_url_set(url.get(), CURLUPART_URL, text.c_str(), CURLU_DISALLOW_USER) != CURLUE_OK) {
    return nullptr;
  }
  return url;
}

// Empty if it is absent.
std::string PartOf(const Url& url, CURLUPart part, unsigned flags = 0) {
  char* text = nullptr;
  if (curl_url_get(url.get(), part, &text, flags) != CURLUE_OK) return "";
  std::string copy(text);
  curl_free(text);
  return copy;
}

// As inet_ntop writes it, if it is an address: one host has one name.
std::string Canonical(std::string host) {
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  std::array<char, INET6_ADDRSTRLEN> text{};
  in6_addr v6{};
  if (inet_pton(AF_INET6, host.c_str(), &v6) == 1) return inet_ntop(AF_INET6, &v6, text.data(), text.size());
  return absl::AsciiStrToLower(host);
}

struct Network {
  std::uint32_t prefix;
  int bits;
};

// RFC 6890, "globally reachable: false", and multicast.
bool IsPublic(std::uint32_t v4) {
  constexpr std::array<Network, 15> kOthers = {{{0x00000000, 8},    // This network.
                                                {0x0A000000, 8},    // Private.
                                                {0x64400000, 10},   // Carriers.
                                                {0x7F000000, 8},    // Loopback.
                                                {0xA9FE0000, 16},   // Link-local, where clouds tell their secrets.
                                                {0xAC100000, 12},   // Private.
                                                {0xC0000000, 24},   // Protocols.
                                                {0xC0000200, 24},   // Documentation.
                                                {0xC0586300, 24},   // Relays from IPv6.
                                                {0xC0A80000, 16},   // Private.
                                                {0xC6120000, 15},   // Benchmarks.
                                                {0xC6336400, 24},   // Documentation.
                                                {0xCB007100, 24},   // Documentation.
                                                {0xE0000000, 4},    // Multicast.
                                                {0xF0000000, 4}}};  // Reserved, broadcast.
  return std::none_of(kOthers.begin(), kOthers.end(), [&](const Network& network) {
    return v4 >> (32 - network.bits) == network.prefix >> (32 - network.bits);
  });
}

// Global unicast, 2000::/3, without what leads elsewhere: protocols with Teredo (2001::/23), documentation
// (2001:db8::/32), and 6to4 (2002::/16).
bool IsPublic(const in6_addr& v6) {
  const auto word = [&](std::size_t i) { return (v6.s6_addr[2 * i] << 8) | v6.s6_addr[2 * i + 1]; };
  if ((word(0) & 0xE000) != 0x2000 || word(0) == 0x2002) return false;
  return word(0) != 0x2001 || ((word(1) & 0xFE00) != 0 && word(1) != 0x0DB8);
}

absl::Status Refused(const std::string& message) {
  return MakeError(absl::StatusCode::kInvalidArgument, "BAD_WEBHOOK", message);
}

}  // namespace

absl::Status WebhookRules::Allow(const std::string& text) {
  absl::Status bad = absl::InvalidArgumentError(
      "\"" + text + "\"; must be HOST or HOST:PORT, such as hooks.example.org or 10.1.2.3:8080");
  // A URL of nothing but this. An asterisk, which names all, is the name of no host.
  if (text.find_first_of("/?#@* ") != std::string::npos) return bad;
  const Url url = Parse("http://" + text);
  if (url == nullptr) return bad;
  Host host;
  host.name = Canonical(PartOf(url, CURLUPART_HOST));
  if (host.name.empty() || !PartOf(url, CURLUPART_ZONEID).empty()) return bad;
  if (const std::string port = PartOf(url, CURLUPART_PORT); !port.empty()) {
    int number = 0;
    if (!absl::SimpleAtoi(port, &number) || number < 1) return bad;
    host.port = number;
  }
  hosts_.push_back(text);
  allowed_.push_back(std::move(host));
  return absl::OkStatus();
}

bool WebhookRules::Allows(const std::string& host, int port, int usual_port) const {
  return std::any_of(allowed_.begin(), allowed_.end(), [&](const Host& allowed) {
    return allowed.name == host && port == allowed.port.value_or(usual_port);
  });
}

absl::Status WebhookRules::Check(const std::string& text) const {
  if (allowed_.empty()) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "WEBHOOKS_OFF",
                     "webhook: this server tells nobody of the end of jobs: it was started without --webhook-allow");
  }
  if (text.size() > kMaxUrlBytes) {
    return Refused("webhook: a URL of " + std::to_string(text.size()) + " bytes; allowed: at most " +
                   std::to_string(kMaxUrlBytes));
  }
  if (!std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; })) {
    return Refused("webhook: the URL has characters other than printable ASCII; write them as %XX");
  }
  const Url url = Parse(text);
  const std::string scheme = url == nullptr ? "" : PartOf(url, CURLUPART_SCHEME);
  if (scheme != "http" && scheme != "https") {
    return Refused("webhook: \"" + text +
                   "\" must be http://HOST or https://HOST, with a path if wanted, and without a user or password");
  }
  if (!PartOf(url, CURLUPART_FRAGMENT).empty() || !PartOf(url, CURLUPART_ZONEID).empty()) {
    return Refused("webhook: \"" + text + "\" must have no fragment (#) and no zone (%)");
  }
  int port = 0;
  const bool has_port = absl::SimpleAtoi(PartOf(url, CURLUPART_PORT, CURLU_DEFAULT_PORT), &port);
  const std::string host = Canonical(PartOf(url, CURLUPART_HOST));
  if (has_port && Allows(host, port, scheme == "http" ? kHttpPort : kHttpsPort)) return absl::OkStatus();
  return Refused("webhook: this server sends nothing to " + host + " port " + std::to_string(port) +
                 "; allowed: " + absl::StrJoin(hosts_, ", "));
}

bool WebhookRules::AllowsAddress(const sockaddr& address) const {
  std::array<char, INET6_ADDRSTRLEN> text{};
  int port = 0;
  if (address.sa_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    if (IsPublic(ntohl(v4.sin_addr.s_addr))) return true;
    inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
    port = ntohs(v4.sin_port);
  } else if (address.sa_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
    if (IsPublic(v6.sin6_addr)) return true;
    inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
    port = ntohs(v6.sin6_port);
  } else {
    return false;
  }
  return Allows(text.data(), port, port == kHttpPort || port == kHttpsPort ? port : 0);
}

std::string WebhookHost(const std::string& url) {
  const Url parsed = Parse(url);
  return parsed == nullptr ? "" : Canonical(PartOf(parsed, CURLUPART_HOST));
}

}  // namespace flatlight
