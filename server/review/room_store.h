// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_REVIEW_ROOM_STORE_H_
#define FLATLIGHT_SERVER_REVIEW_ROOM_STORE_H_

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/review/room.h"
#include "server/store/database.h"
#include "server/store/grants.h"

namespace flatlight {

// The review rooms of a server, in a database. Each change is committed when the call returns, and has not happened if
// it returns an error. Who may do what is not asked here. Safe to use from any thread.
class RoomStore {
 public:
  // `database`: a connection for the store alone, of the newest version.
  RoomStore(const RoomLimits& limits, std::unique_ptr<Database> database)
      : limits_(limits), database_(std::move(database)) {}

  const RoomLimits& limits() const { return limits_; }

  // RESOURCE_EXHAUSTED with TOO_MANY_ROOMS.
  absl::StatusOr<Room> Create(const std::string& owner, const std::string& title, Room::Time now);
  // NOT_FOUND with ROOM_NOT_FOUND, as do all that follow.
  absl::StatusOr<Room> Get(const RoomId& id);
  // These besides FAILED_PRECONDITION with ROOM_CLOSED of a room that is.
  struct Looked {
    Room room;
    std::optional<JobId> before;  // What was looked at.
  };
  absl::StatusOr<Looked> LookAt(const RoomId& id, const ViewChange& change);
  // The note that a call with the same author and request id made before, if there is one (and the id is not empty).
  // RESOURCE_EXHAUSTED with TOO_MANY_NOTES.
  absl::StatusOr<Note> AddNote(const RoomId& id, const Note& note, const std::string& request_id);
  // A closed room stays as it is.
  absl::StatusOr<Room> Close(const RoomId& id, Room::Time now);
  absl::Status Delete(const RoomId& id);

  // At most kMostNotes. OUT_OF_RANGE with SEQUENCE_AHEAD if `sequence` is later than the room's.
  static constexpr std::size_t kMostNotes = 100;
  absl::StatusOr<RoomUpdate> ReadAfter(const RoomId& id, std::uint64_t sequence);

  struct Page {
    std::vector<Room> rooms;                   // Newest first.
    std::optional<std::uint64_t> next_before;  // Where the next page begins; absent on the last page.
  };
  // One who owns rooms, and is all of `who`.
  struct Person {
    std::string name;
    std::vector<Grantee> who;
  };
  // At most `limit` rooms of which `of` is owner or member, or of all; older than `before`.
  absl::StatusOr<Page> List(const std::optional<Person>& of, std::optional<std::uint64_t> before, std::size_t limit);
  // Whether an open room, of which `to` is owner or member, looks at the job.
  absl::StatusOr<bool> Shows(const JobId& job, const Person& to);

  // Whether any open room does.
  absl::StatusOr<bool> IsShown(const JobId& job);

  // As of jobs: see JobStore.
  absl::Status Share(const RoomId& id, const Grant& grant);
  absl::Status Unshare(const RoomId& id, const Grantee& grantee);
  absl::StatusOr<std::vector<Grant>> GrantsOf(const RoomId& id);

 private:
  absl::Status Write(const std::function<absl::Status()>& work);
  // Reads the row of a room; `open`: of one that is.
  enum class Wanted : std::uint8_t { kAny, kOpen };
  struct Row {
    Room room;
    std::int64_t number = 0;
    std::size_t note_bytes = 0;
  };
  absl::StatusOr<Row> Find(const RoomId& id, Wanted wanted) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  static Row RowOf(const Statement& row);
  absl::StatusOr<std::optional<Note>> FindNote(std::int64_t room, const std::string& author,
                                               const std::string& request_id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const RoomLimits limits_;
  std::mutex mutex_;
  const std::unique_ptr<Database> database_ ABSL_PT_GUARDED_BY(mutex_);
};

// NOT_FOUND with ROOM_NOT_FOUND.
absl::Status NoSuchRoom(const RoomId& id);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_REVIEW_ROOM_STORE_H_
