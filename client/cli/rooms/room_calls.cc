// SPDX-License-Identifier: Apache-2.0
#include "client/cli/rooms/room_calls.h"

#include "client/cli/jobs/job_name.h"

namespace flatlight {

absl::StatusOr<std::vector<v1::Room>> ListRooms(Connection& connection) {
  std::vector<v1::Room> rooms;
  v1::ListRoomsRequest request;
  request.set_page_size(1000);
  do {
    const auto response = CallRooms(connection, &v1::ReviewService::Stub::ListRooms, request);
    if (!response.ok()) return response.status();
    rooms.insert(rooms.end(), response->rooms().begin(), response->rooms().end());
    request.set_page_token(response->next_page_token());
  } while (!request.page_token().empty());
  return rooms;
}

absl::StatusOr<std::string> ResolveRoomName(Connection& connection, const std::string& text) {
  std::vector<std::string> names;
  if (!IsWholeName(kRoomNames, text)) {
    const auto rooms = ListRooms(connection);
    if (!rooms.ok()) return rooms.status();
    for (const v1::Room& room : *rooms) names.push_back(room.name());
  }
  return MatchName(kRoomNames, text, names);
}

}  // namespace flatlight
