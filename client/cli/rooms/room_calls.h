// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_ROOMS_ROOM_CALLS_H_
#define FLATLIGHT_CLIENT_CLI_ROOMS_ROOM_CALLS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

// A unary call of ReviewService.
template <class Request, class Response>
absl::StatusOr<Response> CallRooms(Connection& connection,
                                   grpc::Status (v1::ReviewService::Stub::*method)(grpc::ClientContext*, const Request&,
                                                                                   Response*),
                                   const Request& request) {
  return connection.Ask(connection.review(), method, request);
}

// Every room that the caller may see, newest first.
absl::StatusOr<std::vector<v1::Room>> ListRooms(Connection& connection);

// "rooms/{uuid}" from that, from a UUID, or from the beginning of one. Errors end with ExitCode::kUsage.
absl::StatusOr<std::string> ResolveRoomName(Connection& connection, const std::string& text);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_ROOMS_ROOM_CALLS_H_
