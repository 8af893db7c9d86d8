// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_REVIEW_CALLS_H_
#define FLATLIGHT_SERVER_SERVICE_REVIEW_CALLS_H_

#include "absl/status/statusor.h"
#include "flatlight/v1/review_service.pb.h"
#include "server/service/backend.h"
#include "server/service/watch_hub.h"

namespace flatlight {

// The unary calls of ReviewService as plain functions. They tell the hub what changed: in rooms, and of what others may
// see of a job that a room looked at.
class ReviewCalls {
 public:
  ReviewCalls(Backend& backend, WatchHub& hub) : backend_(backend), hub_(hub) {}

  absl::StatusOr<v1::Room> Create(const Caller& caller, const v1::CreateRoomRequest& request);
  absl::StatusOr<v1::Room> Get(const Caller& caller, const v1::GetRoomRequest& request);
  absl::StatusOr<v1::ListRoomsResponse> List(const Caller& caller, const v1::ListRoomsRequest& request);
  absl::StatusOr<v1::Room> Share(const Caller& caller, const v1::ShareRoomRequest& request);
  absl::StatusOr<v1::Room> Unshare(const Caller& caller, const v1::UnshareRoomRequest& request);
  absl::StatusOr<v1::Room> LookAt(const Caller& caller, const v1::LookAtRequest& request);
  absl::StatusOr<v1::Note> AddNote(const Caller& caller, const v1::AddNoteRequest& request);
  absl::StatusOr<v1::Room> Close(const Caller& caller, const v1::CloseRoomRequest& request);
  absl::StatusOr<v1::DeleteRoomResponse> Delete(const Caller& caller, const v1::DeleteRoomRequest& request);

  // Rooms that the caller may not see are NOT_FOUND, in the very words of those that are not there.
  absl::StatusOr<Room> FindSeen(const Caller& caller, const std::string& name);

 private:
  enum class Right : std::uint8_t { kSee, kLead, kOwn };
  // PERMISSION_DENIED with NOT_YOUR_ROOM of a room that the caller may only see.
  absl::StatusOr<Room> Find(const Caller& caller, Right right, const std::string& name);
  absl::StatusOr<v1::Room> WithShares(const Room& room);
  // Who saw `before` by its room may no longer.
  void ViewChanged(const std::optional<JobId>& before);

  Backend& backend_;
  WatchHub& hub_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_REVIEW_CALLS_H_
