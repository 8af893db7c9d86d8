// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_LISTEN_ADDRESS_H_
#define FLATLIGHT_SERVER_SERVICE_LISTEN_ADDRESS_H_

#include <string>

#include "absl/status/statusor.h"

namespace flatlight {

// Where a server listens.
struct ListenAddress {
  std::string host;  // "127.0.0.1", "[::1]", "0.0.0.0"; empty for a Unix socket.
  int port = 0;
  std::string path;             // Of a Unix socket; empty otherwise.
  bool of_this_machine = true;  // No other one can reach it.

  // In gRPC's words; `bound_port` replaces the port.
  std::string ToString(int bound_port) const;
};

// Reads HOST:PORT or unix:PATH; a host is an address of this machine, or localhost. INVALID_ARGUMENT says what is
// allowed, also where other machines could reach it without TLS.
absl::StatusOr<ListenAddress> ParseListenAddress(const std::string& text, bool with_tls = false);

// Why a server cannot listen there, in the system's words; empty if it can.
std::string WhyNotListening(const ListenAddress& address);

// Whether something accepts connections on a Unix socket: gRPC would push it aside.
bool IsListening(const std::string& path);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_LISTEN_ADDRESS_H_
