// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_ROOM_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_ROOM_TEXT_H_

#include <string>
#include <vector>

#include "flatlight/v1/review_service.pb.h"

namespace flatlight {

std::string RoomListText(const std::vector<v1::Room>& rooms, double now);
std::string RoomText(const v1::Room& room);
// "jobs/... floor point 7, +1.5 stops, linear".
std::string ViewText(const v1::View& view);
// A line: "2026-11-26T10:00:00Z ada: text (at 0.5,1)".
std::string NoteText(const v1::Note& note);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_ROOM_TEXT_H_
