// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/commands/job_text.h"
#include "client/cli/commands/room_text.h"
#include "client/cli/commands/session.h"
#include "client/cli/formats/json_text.h"
#include "client/cli/formats/timestamp.h"
#include "client/cli/jobs/job_name.h"
#include "client/cli/outputs/outputs.h"
#include "client/cli/rooms/room_calls.h"
#include "client/cli/rooms/room_watch.h"

namespace flatlight {
namespace {

using Stub = v1::ReviewService::Stub;

// `act(connection, name)` with the room that the line names.
template <class Act>
CommandResult InRoom(const CommandLine& line, Interruption& interruption, const Act& act) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  const auto name = ResolveRoomName((*session)->connection(), line.room.room);
  if (!name.ok()) return name.status();
  return act((*session)->connection(), *name);
}

// Prints the room as the last of the calls leaves it.
template <class Text>
CommandResult AnswerRoom(const CommandLine& line, const absl::StatusOr<v1::Room>& room, const Text& text) {
  if (!room.ok()) return room.status();
  return Answer(line.json ? ToJson(*room) : text(*room));
}

// Sends `request` for each grantee, and prints the room as the last call leaves it.
template <class Method, class Request, class SetGrantee>
CommandResult ChangeShares(const CommandLine& line, Interruption& interruption, Method method, Request& request,
                           const SetGrantee& set_grantee) {
  return InRoom(line, interruption, [&](Connection& connection, const std::string& name) {
    request.set_name(name);
    absl::StatusOr<v1::Room> room;
    for (const std::string& grantee : line.grantees) {
      set_grantee(grantee);
      room = CallRooms(connection, method, request);
      if (!room.ok()) break;
    }
    return AnswerRoom(line, room, [](const v1::Room& shared) {
      return shared.name() + " shared with " + SharesText(shared.shares()) + '\n';
    });
  });
}

}  // namespace

CommandResult CreateRoom(const CommandLine& line, Interruption& interruption) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  v1::CreateRoomRequest request;
  request.set_title(line.room.title);
  return AnswerRoom(line, CallRooms((*session)->connection(), &Stub::CreateRoom, request),
                    [](const v1::Room& room) { return room.name() + '\n'; });
}

CommandResult Rooms(const CommandLine& line, Interruption& interruption) {
  const auto session = Session::Open(line, Session::WithoutServer::kRefuse, interruption);
  if (!session.ok()) return session.status();
  const auto rooms = ListRooms((*session)->connection());
  if (!rooms.ok()) return rooms.status();
  if (!line.json) return Answer(RoomListText(*rooms, SecondsNow()));
  v1::ListRoomsResponse all;
  all.mutable_rooms()->Add(rooms->begin(), rooms->end());
  return Answer(ToJson(all));
}

CommandResult ShowRoom(const CommandLine& line, Interruption& interruption) {
  return InRoom(line, interruption, [&](Connection& connection, const std::string& name) -> CommandResult {
    v1::GetRoomRequest request;
    request.set_name(name);
    const auto room = CallRooms(connection, &Stub::GetRoom, request);
    if (!room.ok()) return room.status();
    v1::WatchRoomResponse whole;
    const auto forget = [&] {
      whole.Clear();
      return absl::OkStatus();
    };
    const auto add = [&](const v1::WatchRoomResponse& update) {
      whole.mutable_notes()->MergeFrom(update.notes());
      return absl::OkStatus();
    };
    absl::Status read = WatchRoom(connection, name, {.to_end = false, .on_update = add, .on_new_epoch = forget});
    if (!read.ok()) return read;
    *whole.mutable_room() = *room;
    if (line.json) return Answer(ToJson(whole));
    std::string text = RoomText(*room);
    if (!whole.notes().empty()) text += '\n';
    for (const v1::Note& note : whole.notes()) text += NoteText(note);
    return Answer(text);
  });
}

CommandResult WatchRoom(const CommandLine& line, Interruption& interruption) {
  return InRoom(line, interruption, [&](Connection& connection, const std::string& name) -> CommandResult {
    std::string view;  // As it was said last.
    RoomWatchOptions options;
    options.on_new_epoch = [&] { return PrintBytes(line.json ? "" : "the server went back to a backup\n"); };
    options.on_update = [&](const v1::WatchRoomResponse& update) {
      if (line.json) return PrintBytes(ToJsonLine(update));
      std::string text;
      for (const v1::Note& note : update.notes()) text += NoteText(note);
      const std::string now = ViewText(update.room().view());
      if (now != view) text += "looks at " + now + '\n';
      view = now;
      if (update.room().has_close_time() && !update.more()) text += "closed\n";
      return PrintBytes(text);
    };
    if (absl::Status watched = WatchRoom(connection, name, options); !watched.ok()) return watched;
    return ExitCode::kDone;
  });
}

CommandResult NoteInRoom(const CommandLine& line, Interruption& interruption) {
  return InRoom(line, interruption, [&](Connection& connection, const std::string& name) -> CommandResult {
    v1::AddNoteRequest request = line.room.note;
    request.set_name(name);
    request.set_request_id(NewUuid());
    const auto note = CallRooms(connection, &Stub::AddNote, request);
    if (!note.ok()) return note.status();
    return Answer(line.json ? ToJson(*note) : NoteText(*note));
  });
}

CommandResult LookInRoom(const CommandLine& line, Interruption& interruption) {
  return InRoom(line, interruption, [&](Connection& connection, const std::string& name) -> CommandResult {
    v1::LookAtRequest request = line.room.view;
    request.set_name(name);
    if (!request.job().empty()) {
      const auto job = ResolveJobName(connection, request.job());
      if (!job.ok()) return job.status();
      request.set_job(*job);
    }
    return AnswerRoom(line, CallRooms(connection, &Stub::LookAt, request),
                      [](const v1::Room& room) { return "looks at " + ViewText(room.view()) + '\n'; });
  });
}

CommandResult ShareRoom(const CommandLine& line, Interruption& interruption) {
  v1::ShareRoomRequest request;
  request.mutable_share()->set_access(line.control ? v1::Share::CONTROL : v1::Share::READ);
  return ChangeShares(line, interruption, &Stub::ShareRoom, request,
                      [&](const std::string& grantee) { request.mutable_share()->set_grantee(grantee); });
}

CommandResult UnshareRoom(const CommandLine& line, Interruption& interruption) {
  v1::UnshareRoomRequest request;
  return ChangeShares(line, interruption, &Stub::UnshareRoom, request,
                      [&](const std::string& grantee) { request.set_grantee(grantee); });
}

CommandResult CloseRoom(const CommandLine& line, Interruption& interruption) {
  return InRoom(line, interruption, [&](Connection& connection, const std::string& name) {
    v1::CloseRoomRequest request;
    request.set_name(name);
    return AnswerRoom(line, CallRooms(connection, &Stub::CloseRoom, request),
                      [](const v1::Room& room) { return room.name() + " closed\n"; });
  });
}

CommandResult DeleteRoom(const CommandLine& line, Interruption& interruption) {
  return InRoom(line, interruption, [&](Connection& connection, const std::string& name) -> CommandResult {
    v1::DeleteRoomRequest request;
    request.set_name(name);
    const auto deleted = CallRooms(connection, &Stub::DeleteRoom, request);
    if (!deleted.ok()) return deleted.status();
    return Answer(name + " deleted\n");
  });
}

}  // namespace flatlight
