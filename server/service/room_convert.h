// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_ROOM_CONVERT_H_
#define FLATLIGHT_SERVER_SERVICE_ROOM_CONVERT_H_

#include <string>

#include "absl/status/statusor.h"
#include "flatlight/v1/review_service.pb.h"
#include "server/review/room.h"

namespace flatlight {

v1::Room RoomToProto(const Room& room);
v1::Note NoteToProto(const Note& note);
v1::WatchRoomResponse UpdateToProto(const RoomUpdate& update);

// INVALID_ARGUMENT if `name` is not rooms/{uuid}.
absl::StatusOr<RoomId> ParseRoomName(const std::string& name);
// INVALID_ARGUMENT of what is not in the ranges that the API states, with its place, as of all below.
absl::StatusOr<ViewChange> ViewChangeFromProto(const v1::LookAtRequest& request);
absl::StatusOr<Note> NoteFromProto(const v1::AddNoteRequest& request, const RoomLimits& limits);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_ROOM_CONVERT_H_
