// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/server_address.h"

#include <arpa/inet.h>
#include <sys/un.h>

#include <charconv>
#include <filesystem>

#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxSocketPath = sizeof(sockaddr_un{}.sun_path) - 1;

bool IsPort(const std::string& text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port >= 1 && port <= 65535;
}

bool IsNumeric(int family, const std::string& host) {
  in6_addr address{};
  return inet_pton(family, host.c_str(), &address) == 1;
}

}  // namespace

absl::StatusOr<ServerAddress> ParseServerAddress(const std::string& text, const std::string& source) {
  const auto refuse = [&](const std::string& reason) {
    return UsageError(source + ": '" + text + "' " + reason + "; must be HOST:PORT or unix:PATH");
  };
  ServerAddress address;
  address.text = text;
  if (text.starts_with("unix:")) {
    const std::string path = text.substr(5);
    if (path.empty()) return refuse("names no socket");
    const std::string absolute = std::filesystem::absolute(path).string();
    if (absolute.size() > kMaxSocketPath)
      return refuse("is longer than the " + std::to_string(kMaxSocketPath) + " bytes of a socket's path");
    address.target = "unix:" + absolute;
    address.local = true;
    return address;
  }
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return refuse("has no port");
  std::string host = text.substr(0, colon);
  const std::string port = text.substr(colon + 1);
  if (!IsPort(port)) return refuse("has the port '" + port + "', not a number from 1 to 65535");
  const bool bracketed = host.size() >= 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  if (host.empty()) return refuse("has no host");
  if (host.find('/') != std::string::npos) return refuse("is not an address");
  if (IsNumeric(AF_INET6, host)) {
    if (!bracketed) return refuse("needs brackets around the IPv6 address");
    address.target = "ipv6:[" + host + "]:" + port;
  } else if (bracketed || host.find(':') != std::string::npos) {
    return refuse("has no IPv6 address in brackets");
  } else {
    // An address needs no resolver, which costs some milliseconds.
    address.target = (IsNumeric(AF_INET, host) ? "ipv4:" : "dns:///") + host + ":" + port;
  }
  address.local = host == "localhost" || host == "::1" || host.starts_with("127.");
  return address;
}

}  // namespace flatlight
