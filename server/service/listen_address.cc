// SPDX-License-Identifier: Apache-2.0
#include "server/service/listen_address.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>
#include <system_error>

#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr std::string_view kUnix = "unix:";

absl::Status BadAddress(const std::string& message) {
  return MakeError(absl::StatusCode::kInvalidArgument, "BAD_ADDRESS", message);
}

std::optional<in_addr> Address4(const std::string& host) {
  in_addr address{};
  if (inet_pton(AF_INET, host.c_str(), &address) != 1) return std::nullopt;
  return address;
}

// Of "[::1]".
std::optional<in6_addr> Address6(const std::string& host) {
  in6_addr address{};
  if (host.size() < 2 || host.front() != '[' || host.back() != ']') return std::nullopt;
  if (inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), &address) != 1) return std::nullopt;
  return address;
}

sockaddr_un UnixAddress(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size());
  return address;
}

}  // namespace

std::string ListenAddress::ToString(int bound_port) const {
  return path.empty() ? host + ":" + std::to_string(bound_port) : "unix:" + path;
}

absl::StatusOr<ListenAddress> ParseListenAddress(const std::string& text, bool with_tls) {
  ListenAddress address;
  if (std::string_view(text).starts_with(kUnix)) {
    address.path = text.substr(kUnix.size());
    const std::size_t longest = sizeof(sockaddr_un{}.sun_path) - 1;
    if (address.path.empty() || address.path.size() > longest) {
      return BadAddress("the path of a Unix socket has " + std::to_string(address.path.size()) +
                        " bytes; allowed: 1 to " + std::to_string(longest));
    }
    return address;
  }
  const std::size_t colon = text.rfind(':');
  const std::string form =
      "\"" + text + "\" is not an address; give HOST:PORT or unix:PATH, for instance 127.0.0.1:7000";
  if (colon == std::string::npos) return BadAddress(form);
  const char* end = text.data() + text.size();
  const auto port = std::from_chars(text.data() + colon + 1, end, address.port);
  if (port.ec != std::errc() || port.ptr != end || address.port < 0 || address.port > 65535) return BadAddress(form);
  address.host = text.substr(0, colon);
  if (address.host == "localhost") address.host = "127.0.0.1";
  const auto four = Address4(address.host);
  const auto six = Address6(address.host);
  address.of_this_machine = (four && (ntohl(four->s_addr) >> 24) == 127) || (six && IN6_IS_ADDR_LOOPBACK(&*six));
  if (!address.of_this_machine && !with_tls) {
    return BadAddress("\"" + address.host +
                      "\" is not a loopback address; without TLS this server is for its own machine: 127.0.0.1, [::1], "
                      "localhost or unix:PATH");
  }
  if (!four && !six) {
    return BadAddress(
        "\"" + address.host +
        "\" is not an address of this machine; give one in numbers, for instance 0.0.0.0 or [::] for all");
  }
  return address;
}

std::string WhyNotListening(const ListenAddress& address) {
  const auto try_to_bind = [](const auto& socket_address) {
    const auto* const generic = reinterpret_cast<const sockaddr*>(&socket_address);
    const int socket_fd = socket(generic->sa_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (socket_fd < 0) return errno;
    const int error = bind(socket_fd, generic, sizeof(socket_address)) == 0 ? 0 : errno;
    close(socket_fd);
    return error;
  };
  const auto port = htons(static_cast<std::uint16_t>(address.port));
  int error = 0;
  if (!address.path.empty()) {
    error = try_to_bind(UnixAddress(address.path));
    if (error == 0) unlink(address.path.c_str());
  } else if (const auto six = Address6(address.host)) {
    sockaddr_in6 socket_address{};
    socket_address.sin6_family = AF_INET6;
    socket_address.sin6_addr = *six;
    socket_address.sin6_port = port;
    error = try_to_bind(socket_address);
  } else if (const auto four = Address4(address.host)) {
    sockaddr_in socket_address{};
    socket_address.sin_family = AF_INET;
    socket_address.sin_addr = *four;
    socket_address.sin_port = port;
    error = try_to_bind(socket_address);
  }
  return error == 0 ? std::string() : std::generic_category().message(error);
}

bool IsListening(const std::string& path) {
  const sockaddr_un address = UnixAddress(path);
  const int socket_fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket_fd < 0) return false;
  const bool connected = connect(socket_fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  close(socket_fd);
  return connected;
}

}  // namespace flatlight
