// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_SERVER_ADDRESS_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_SERVER_ADDRESS_H_

#include <string>

#include "absl/status/statusor.h"

namespace flatlight {

struct ServerAddress {
  std::string text;    // As the user wrote it, for messages.
  std::string target;  // As gRPC wants it.
  bool local = false;  // A Unix socket or a loopback address: no proxy can be meant.
};

// HOST:PORT ([ADDRESS]:PORT for IPv6) or unix:PATH; `source` ("--server") names where it came from.
absl::StatusOr<ServerAddress> ParseServerAddress(const std::string& text, const std::string& source);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_SERVER_ADDRESS_H_
