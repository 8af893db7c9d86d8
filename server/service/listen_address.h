// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_LISTEN_ADDRESS_H_
#define FLATLIGHT_SERVER_SERVICE_LISTEN_ADDRESS_H_

#include <string>

#include "absl/status/statusor.h"

namespace flatlight {

// Where a server listens: without TLS only where no other machine can reach it.
struct ListenAddress {
  std::string host;  // "127.0.0.1", "[::1]"; empty for a Unix socket.
  int port = 0;
  std::string path;  // Of a Unix socket; empty otherwise.

  // In gRPC's words; `bound_port` replaces the port.
  std::string ToString(int bound_port) const;
};

// Reads HOST:PORT (a loopback host) or unix:PATH. INVALID_ARGUMENT says what is allowed.
absl::StatusOr<ListenAddress> ParseListenAddress(const std::string& text);

// Why a server cannot listen there, in the system's words; empty if it can.
std::string WhyNotListening(const ListenAddress& address);

// Whether something accepts connections on a Unix socket: gRPC would push it aside.
bool IsListening(const std::string& path);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_LISTEN_ADDRESS_H_
