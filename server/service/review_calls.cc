// SPDX-License-Identifier: Apache-2.0
#include "server/service/review_calls.h"

#include <chrono>
#include <optional>
#include <utility>

#include "server/service/job_convert.h"
#include "server/service/page.h"
#include "server/service/room_convert.h"
#include "server/service/status_convert.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxRequestIdBytes = 128;

Room::Time Now() { return std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now()); }

// May do all with a room.
bool Owns(const Caller& caller, const Room& room) {
  return room.owner == caller.name || caller.role >= Role::kInstructor;
}

std::string BytesError(std::size_t bytes, std::size_t least, std::size_t most) {
  return std::to_string(bytes) + " bytes; allowed: " + std::to_string(least) + " to " + std::to_string(most);
}

}  // namespace

absl::StatusOr<Room> ReviewCalls::Find(const Caller& caller, Right right, const std::string& name) {
  const auto id = ParseRoomName(name);
  if (!id.ok()) return id.status();
  auto room = backend_.rooms.Get(*id);
  if (!room.ok() || Owns(caller, *room)) return room;
  const auto grants = backend_.rooms.GrantsOf(*id);
  if (!grants.ok()) return grants.status();
  const auto access = AccessOf(*grants, Grantee::Of(caller.name, caller.groups));
  if (!access) return NoSuchRoom(*id);
  const Right has = *access == Access::kControl ? Right::kLead : Right::kSee;
  if (has >= right) return room;
  return MakeError(absl::StatusCode::kPermissionDenied, "NOT_YOUR_ROOM",
                   name + " is " + room->owner + "'s: you may watch it and write notes" +
                       (has == Right::kLead ? ", and change what is looked at" : ""));
}

absl::StatusOr<Room> ReviewCalls::FindSeen(const Caller& caller, const std::string& name) {
  return Find(caller, Right::kSee, name);
}

absl::StatusOr<v1::Room> ReviewCalls::WithShares(const Room& room) {
  const auto grants = backend_.rooms.GrantsOf(room.id);
  if (!grants.ok()) return grants.status();
  v1::Room whole = RoomToProto(room);
  for (const Grant& grant : *grants) *whole.add_shares() = GrantToProto(grant);
  return whole;
}

void ReviewCalls::ViewChanged(const std::optional<JobId>& before) {
  if (before) hub_.AccessChanged(before->Name());
}

absl::StatusOr<v1::Room> ReviewCalls::Create(const Caller& caller, const v1::CreateRoomRequest& request) {
  const std::size_t most = backend_.rooms.limits().title_bytes;
  if (request.title().empty() || request.title().size() > most) {
    return MakeFieldError("title", BytesError(request.title().size(), 1, most));
  }
  const auto room = backend_.rooms.Create(caller.name, request.title(), Now());
  if (!room.ok()) return room.status();
  return RoomToProto(*room);
}

absl::StatusOr<v1::Room> ReviewCalls::Get(const Caller& caller, const v1::GetRoomRequest& request) {
  const auto room = FindSeen(caller, request.name());
  if (!room.ok()) return room.status();
  return Owns(caller, *room) ? WithShares(*room) : RoomToProto(*room);
}

absl::StatusOr<v1::ListRoomsResponse> ReviewCalls::List(const Caller& caller, const v1::ListRoomsRequest& request) {
  std::optional<RoomStore::Person> of;
  if (caller.role < Role::kInstructor) of = {caller.name, Grantee::Of(caller.name, caller.groups)};
  const std::string list = (of ? "rooms of " : "all rooms, for ") + caller.name;
  const auto page = ParsePage(backend_.page_tokens, list, request.page_size(), request.page_token());
  if (!page.ok()) return page.status();
  const auto rooms = backend_.rooms.List(of, page->position, page->size);
  if (!rooms.ok()) return rooms.status();
  v1::ListRoomsResponse response;
  for (const Room& room : rooms->rooms) *response.add_rooms() = RoomToProto(room);
  if (rooms->next_before) response.set_next_page_token(backend_.page_tokens.Seal(list, *rooms->next_before));
  return response;
}

absl::StatusOr<v1::Room> ReviewCalls::Share(const Caller& caller, const v1::ShareRoomRequest& request) {
  const auto grant = GrantFromProto(request.share());
  if (!grant.ok()) return grant.status();
  const auto room = Find(caller, Right::kOwn, request.name());
  if (!room.ok()) return room.status();
  if (absl::Status shared = backend_.rooms.Share(room->id, *grant); !shared.ok()) return shared;
  return WithShares(*room);
}

absl::StatusOr<v1::Room> ReviewCalls::Unshare(const Caller& caller, const v1::UnshareRoomRequest& request) {
  const auto grantee = GranteeFromProto("grantee", request.grantee());
  if (!grantee.ok()) return grantee.status();
  const auto room = Find(caller, Right::kOwn, request.name());
  if (!room.ok()) return room.status();
  if (absl::Status changed = backend_.rooms.Unshare(room->id, *grantee); !changed.ok()) return changed;
  hub_.AccessChanged(room->id.Name());
  ViewChanged(room->view.job);
  return WithShares(*room);
}

absl::StatusOr<v1::Room> ReviewCalls::LookAt(const Caller& caller, const v1::LookAtRequest& request) {
  const auto change = ViewChangeFromProto(request);
  if (!change.ok()) return change.status();
  const auto room = Find(caller, Right::kLead, request.name());
  if (!room.ok()) return room.status();
  if (change->job && *change->job) {
    absl::Status may_show = backend_.access.CheckRight(caller, JobRight::kOwn, **change->job);
    if (!may_show.ok()) return may_show;
  }
  const auto looked = backend_.rooms.LookAt(room->id, *change);
  if (!looked.ok()) return looked.status();
  hub_.Changed(room->id.Name());
  if (looked->room.view.job != looked->before) ViewChanged(looked->before);
  return RoomToProto(looked->room);
}

absl::StatusOr<v1::Note> ReviewCalls::AddNote(const Caller& caller, const v1::AddNoteRequest& request) {
  auto note = NoteFromProto(request, backend_.rooms.limits());
  if (!note.ok()) return note.status();
  if (request.request_id().size() > kMaxRequestIdBytes) {
    return MakeFieldError("request_id", BytesError(request.request_id().size(), 0, kMaxRequestIdBytes));
  }
  const auto room = FindSeen(caller, request.name());
  if (!room.ok()) return room.status();
  note->author = caller.name;
  note->time = Now();
  const auto added = backend_.rooms.AddNote(room->id, *note, request.request_id());
  if (!added.ok()) return added.status();
  hub_.Changed(room->id.Name());
  return NoteToProto(*added);
}

absl::StatusOr<v1::Room> ReviewCalls::Close(const Caller& caller, const v1::CloseRoomRequest& request) {
  const auto before = Find(caller, Right::kOwn, request.name());
  if (!before.ok()) return before.status();
  const auto room = backend_.rooms.Close(before->id, Now());
  if (!room.ok()) return room.status();
  hub_.Changed(room->id.Name());
  ViewChanged(room->view.job);
  return WithShares(*room);
}

absl::StatusOr<v1::DeleteRoomResponse> ReviewCalls::Delete(const Caller& caller, const v1::DeleteRoomRequest& request) {
  const auto room = Find(caller, Right::kOwn, request.name());
  if (!room.ok()) return room.status();
  if (absl::Status deleted = backend_.rooms.Delete(room->id); !deleted.ok()) return deleted;
  hub_.Changed(room->id.Name());
  ViewChanged(room->view.job);
  return v1::DeleteRoomResponse();
}

}  // namespace flatlight
