// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_OPTIONS_ROOM_OPTIONS_H_
#define FLATLIGHT_CLIENT_CLI_OPTIONS_ROOM_OPTIONS_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "flatlight/v1/review_service.pb.h"

namespace flatlight {

// Of `room`, as written.
struct RoomTexts {
  std::string room;
  std::string title;
  std::string text;
  std::optional<std::string> at;
  std::optional<std::string> job;
  std::optional<std::string> probe;
  std::optional<std::string> point;
  std::optional<std::string> exposure;
  std::optional<std::string> tone_mapping;
};

struct RoomOptions {
  std::string room;         // ROOM as written.
  std::string title;        // Of `room create`.
  v1::AddNoteRequest note;  // Of `room note`, without the room's name.
  v1::LookAtRequest view;   // Of `room look`, without the room's name; the job is as written.
};

// Errors end with ExitCode::kUsage.
absl::StatusOr<RoomOptions> ParseRoomOptions(const RoomTexts& texts);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OPTIONS_ROOM_OPTIONS_H_
