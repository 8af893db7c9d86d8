// SPDX-License-Identifier: Apache-2.0
#include "server/review/room_store.h"

#include <utility>

#include "server/store/error.h"
#include "server/store/grant_table.h"
#include "server/store/random_bytes.h"

namespace flatlight {
namespace {

constexpr char kRoomColumns[] =
    "SELECT number, uuid, epoch, owner, title, create_time, close_time, sequence, notes, note_bytes, job, probe, "
    "point, "
    "exposure, tone_mapping FROM rooms ";
constexpr char kNoteColumns[] = "SELECT sequence, author, time, text, x, y, job FROM notes ";
constexpr std::string_view kPhotographic = "photographic";
constexpr std::string_view kLinear = "linear";

std::int64_t Milliseconds(Room::Time time) { return time.time_since_epoch().count(); }

Room::Time TimeOf(std::int64_t milliseconds) { return Room::Time(std::chrono::milliseconds(milliseconds)); }

std::optional<std::string> NameOf(const std::optional<JobId>& job) {
  return job ? std::optional(job->Name()) : std::nullopt;
}

std::optional<JobId> JobOf(const std::optional<std::string>& name) {
  return name ? JobId::FromName(*name) : std::nullopt;
}

Note NoteOf(const Statement& row) {
  Note note;
  note.sequence = static_cast<std::uint64_t>(row.Integer(0));
  note.author = row.Bytes(1);
  note.time = TimeOf(row.Integer(2));
  note.text = row.Bytes(3);
  if (row.OptionalBytes(4)) note.place = Point2{row.Real(4), row.Real(5)};
  note.job = JobOf(row.OptionalBytes(6));
  return note;
}

void Apply(const ViewChange& change, RoomView& view) {
  if (change.job) view = {.job = *change.job, .exposure = view.exposure, .tone_mapping = view.tone_mapping};
  if (change.probe) {
    view.probe = *change.probe;
    view.point.reset();
  }
  if (change.point) view.point = change.point;
  view.exposure = change.exposure.value_or(view.exposure);
  view.tone_mapping = change.tone_mapping.value_or(view.tone_mapping);
}

// For rooms of which somebody is owner or member; BindPerson fills its places.
std::string OfPerson(const RoomStore::Person& person) {
  return "(owner = ? OR 'rooms/' || uuid IN " + ResourcesOf(person.who) + ")";
}

void BindPerson(const RoomStore::Person& person, Statement& statement) {
  statement.Bind(std::string_view(person.name));
  BindGrantees(person.who, statement);
}

}  // namespace

absl::Status NoSuchRoom(const RoomId& id) {
  return MakeError(absl::StatusCode::kNotFound, "ROOM_NOT_FOUND", id.Name() + " does not exist");
}

absl::Status RoomStore::Write(const std::function<absl::Status()>& work) {
  Transaction transaction(*database_);
  if (absl::Status begun = transaction.Begin(); !begun.ok()) return begun;
  if (absl::Status done = work(); !done.ok()) return done;
  return transaction.Commit();
}

RoomStore::Row RoomStore::RowOf(const Statement& row) {
  Row found{{.id = *RoomId::FromName("rooms/" + row.Bytes(1))}, row.Integer(0)};
  Room& room = found.room;
  room.epoch = static_cast<std::uint64_t>(row.Integer(2));
  room.owner = row.Bytes(3);
  room.title = row.Bytes(4);
  room.create_time = TimeOf(row.Integer(5));
  if (row.OptionalBytes(6)) room.close_time = TimeOf(row.Integer(6));
  room.sequence = static_cast<std::uint64_t>(row.Integer(7));
  room.notes = static_cast<std::uint32_t>(row.Integer(8));
  found.note_bytes = static_cast<std::size_t>(row.Integer(9));
  room.view.job = JobOf(row.OptionalBytes(10));
  room.view.probe = row.Bytes(11);
  if (row.OptionalBytes(12)) room.view.point = static_cast<std::uint32_t>(row.Integer(12));
  room.view.exposure = row.Real(13);
  room.view.tone_mapping = row.Bytes(14) == kLinear ? ToneMapping::kLinear : ToneMapping::kPhotographic;
  return found;
}

absl::StatusOr<RoomStore::Row> RoomStore::Find(const RoomId& id, Wanted wanted) {
  Statement rooms = database_->Prepare(std::string(kRoomColumns) + "WHERE uuid = ?");
  const auto row = rooms.Bind(std::string_view(id.uuid())).Step();
  if (!row.ok()) return row.status();
  if (!*row) return NoSuchRoom(id);
  Row found = RowOf(rooms);
  if (wanted == Wanted::kOpen && found.room.close_time) {
    return MakeError(absl::StatusCode::kFailedPrecondition, "ROOM_CLOSED",
                     id.Name() + " is closed: it can be read, and nothing more");
  }
  return found;
}

absl::StatusOr<Room> RoomStore::Create(const std::string& owner, const std::string& title, Room::Time now) {
  const std::lock_guard lock(mutex_);
  Room room{.id = RoomId::Random(),
            .epoch = RandomEpoch(),
            .owner = owner,
            .title = title,
            .create_time = now,
            .sequence = 1};
  const absl::Status written = Write([&]() -> absl::Status {
    Statement count = database_->Prepare("SELECT count(*) FROM rooms WHERE owner = ?");
    if (const auto row = count.Bind(std::string_view(owner)).Step(); !row.ok()) return row.status();
    if (count.Integer(0) >= static_cast<std::int64_t>(limits_.rooms_per_user)) {
      return MakeError(absl::StatusCode::kResourceExhausted, "TOO_MANY_ROOMS",
                       owner + " has " + std::to_string(count.Integer(0)) + " review rooms; allowed: " +
                           std::to_string(limits_.rooms_per_user) + "; delete one of them");
    }
    return database_
        ->Prepare(
            "INSERT INTO rooms(uuid, epoch, owner, title, create_time, sequence, tone_mapping) VALUES(?, ?, ?, ?, ?, "
            "1, ?)")
        .Bind(std::string_view(room.id.uuid()))
        .Bind(static_cast<std::int64_t>(room.epoch))
        .Bind(std::string_view(owner))
        .Bind(std::string_view(title))
        .Bind(Milliseconds(now))
        .Bind(kPhotographic)
        .Run();
  });
  if (!written.ok()) return written;
  return room;
}

absl::StatusOr<Room> RoomStore::Get(const RoomId& id) {
  const std::lock_guard lock(mutex_);
  auto row = Find(id, Wanted::kAny);
  if (!row.ok()) return row.status();
  return std::move(row->room);
}

absl::StatusOr<RoomStore::Looked> RoomStore::LookAt(const RoomId& id, const ViewChange& change) {
  const std::lock_guard lock(mutex_);
  absl::StatusOr<Row> row;
  std::optional<JobId> before;
  const absl::Status written = Write([&]() -> absl::Status {
    row = Find(id, Wanted::kOpen);
    if (!row.ok()) return row.status();
    Room& room = row->room;
    before = room.view.job;
    ++room.sequence;
    Apply(change, room.view);
    Statement update = database_->Prepare(
        "UPDATE rooms SET sequence = ?, job = ?, probe = ?, point = ?, exposure = ?, tone_mapping = ? WHERE number = "
        "?");
    update.Bind(static_cast<std::int64_t>(room.sequence)).Bind(NameOf(room.view.job));
    update.Bind(std::string_view(room.view.probe));
    if (room.view.point) {
      update.Bind(std::int64_t{*room.view.point});
    } else {
      update.BindNull();
    }
    update.BindReal(room.view.exposure);
    update.Bind(room.view.tone_mapping == ToneMapping::kLinear ? kLinear : kPhotographic);
    return update.Bind(row->number).Run();
  });
  if (!written.ok()) return written;
  return Looked{std::move(row->room), std::move(before)};
}

absl::StatusOr<std::optional<Note>> RoomStore::FindNote(std::int64_t room, const std::string& author,
                                                        const std::string& request_id) {
  if (request_id.empty()) return std::nullopt;
  Statement notes = database_->Prepare(std::string(kNoteColumns) + "WHERE room = ? AND author = ? AND request_id = ?");
  notes.Bind(room).Bind(std::string_view(author)).Bind(std::string_view(request_id));
  const auto row = notes.Step();
  if (!row.ok()) return row.status();
  return *row ? std::optional(NoteOf(notes)) : std::nullopt;
}

absl::StatusOr<Note> RoomStore::AddNote(const RoomId& id, const Note& given, const std::string& request_id) {
  const std::lock_guard lock(mutex_);
  Note note = given;
  const absl::Status written = Write([&]() -> absl::Status {
    const auto row = Find(id, Wanted::kOpen);
    if (!row.ok()) return row.status();
    auto earlier = FindNote(row->number, given.author, request_id);
    if (!earlier.ok()) return earlier.status();
    if (*earlier) {
      note = **std::move(earlier);
      return absl::OkStatus();
    }
    const std::size_t bytes = row->note_bytes + given.text.size();
    if (row->room.notes >= limits_.notes || bytes > limits_.all_bytes) {
      return MakeError(absl::StatusCode::kResourceExhausted, "TOO_MANY_NOTES",
                       id.Name() + " has " + std::to_string(row->room.notes) + " notes of " +
                           std::to_string(row->note_bytes) + " bytes; allowed: " + std::to_string(limits_.notes) +
                           " notes, " + std::to_string(limits_.all_bytes) + " bytes; go on in another room");
    }
    note.sequence = row->room.sequence + 1;
    note.job = row->room.view.job;
    Statement insert = database_->Prepare(
        "INSERT INTO notes(room, sequence, author, time, text, x, y, job, request_id) VALUES(?, ?, ?, ?, ?, ?, ?, ?, "
        "?)");
    insert.Bind(row->number).Bind(static_cast<std::int64_t>(note.sequence)).Bind(std::string_view(note.author));
    insert.Bind(Milliseconds(note.time)).Bind(std::string_view(note.text));
    if (note.place) {
      insert.BindReal(note.place->x).BindReal(note.place->y);
    } else {
      insert.BindNull().BindNull();
    }
    insert.Bind(NameOf(note.job)).Bind(std::string_view(request_id));
    if (absl::Status inserted = insert.Run(); !inserted.ok()) return inserted;
    return database_->Prepare("UPDATE rooms SET sequence = ?, notes = notes + 1, note_bytes = ? WHERE number = ?")
        .Bind(static_cast<std::int64_t>(note.sequence))
        .Bind(static_cast<std::int64_t>(bytes))
        .Bind(row->number)
        .Run();
  });
  if (!written.ok()) return written;
  return note;
}

absl::StatusOr<Room> RoomStore::Close(const RoomId& id, Room::Time now) {
  const std::lock_guard lock(mutex_);
  absl::StatusOr<Row> row;
  const absl::Status written = Write([&]() -> absl::Status {
    row = Find(id, Wanted::kAny);
    if (!row.ok() || row->room.close_time) return row.status();
    row->room.close_time = now;
    ++row->room.sequence;
    return database_->Prepare("UPDATE rooms SET close_time = ?, sequence = ? WHERE number = ?")
        .Bind(Milliseconds(now))
        .Bind(static_cast<std::int64_t>(row->room.sequence))
        .Bind(row->number)
        .Run();
  });
  if (!written.ok()) return written;
  return std::move(row->room);
}

absl::Status RoomStore::Delete(const RoomId& id) {
  const std::lock_guard lock(mutex_);
  return Write([&]() -> absl::Status {
    const auto row = Find(id, Wanted::kAny);
    if (!row.ok()) return row.status();
    return database_->Prepare("DELETE FROM rooms WHERE number = ?").Bind(row->number).Run();
  });
}

absl::StatusOr<RoomUpdate> RoomStore::ReadAfter(const RoomId& id, std::uint64_t sequence) {
  const std::lock_guard lock(mutex_);
  auto row = Find(id, Wanted::kAny);
  if (!row.ok()) return row.status();
  if (sequence > row->room.sequence) {
    return MakeError(absl::StatusCode::kOutOfRange, "SEQUENCE_AHEAD",
                     "after_sequence is " + std::to_string(sequence) + "; " + id.Name() + " is at " +
                         std::to_string(row->room.sequence));
  }
  RoomUpdate update{.room = std::move(row->room)};
  update.sequence = update.room.sequence;
  Statement notes =
      database_->Prepare(std::string(kNoteColumns) + "WHERE room = ? AND sequence > ? ORDER BY sequence LIMIT ?");
  notes.Bind(row->number).Bind(static_cast<std::int64_t>(sequence)).Bind(std::int64_t{kMostNotes + 1});
  while (true) {
    const auto more = notes.Step();
    if (!more.ok()) return more.status();
    if (!*more) return update;
    if (update.notes.size() == kMostNotes) {
      update.sequence = update.notes.back().sequence;
      return update;
    }
    update.notes.push_back(NoteOf(notes));
  }
}

absl::StatusOr<RoomStore::Page> RoomStore::List(const std::optional<Person>& of, std::optional<std::uint64_t> before,
                                                std::size_t limit) {
  const std::lock_guard lock(mutex_);
  Statement rooms = database_->Prepare(std::string(kRoomColumns) + "WHERE number < ? AND " +
                                       (of ? OfPerson(*of) : "1") + " ORDER BY number DESC LIMIT ?");
  rooms.Bind(before ? static_cast<std::int64_t>(*before) : INT64_MAX);
  if (of) BindPerson(*of, rooms);
  rooms.Bind(static_cast<std::int64_t>(limit) + 1);
  Page page;
  std::int64_t last = 0;
  while (true) {
    const auto row = rooms.Step();
    if (!row.ok()) return row.status();
    if (!*row) return page;
    if (page.rooms.size() == limit) {
      page.next_before = static_cast<std::uint64_t>(last);
      return page;
    }
    Row found = RowOf(rooms);
    last = found.number;
    page.rooms.push_back(std::move(found.room));
  }
}

absl::StatusOr<bool> RoomStore::Shows(const JobId& job, const Person& to) {
  const std::lock_guard lock(mutex_);
  Statement rooms =
      database_->Prepare("SELECT 1 FROM rooms WHERE job = ? AND close_time IS NULL AND " + OfPerson(to) + " LIMIT 1");
  rooms.Bind(std::string_view(job.Name()));
  BindPerson(to, rooms);
  return rooms.Step();
}

absl::StatusOr<bool> RoomStore::IsShown(const JobId& job) {
  const std::lock_guard lock(mutex_);
  Statement rooms = database_->Prepare("SELECT 1 FROM rooms WHERE job = ? AND close_time IS NULL LIMIT 1");
  return rooms.Bind(std::string_view(job.Name())).Step();
}

absl::Status RoomStore::Share(const RoomId& id, const Grant& grant) {
  const std::lock_guard lock(mutex_);
  return Write([&]() -> absl::Status {
    if (const auto row = Find(id, Wanted::kAny); !row.ok()) return row.status();
    return InsertGrant(*database_, id.Name(), grant);
  });
}

absl::Status RoomStore::Unshare(const RoomId& id, const Grantee& grantee) {
  const std::lock_guard lock(mutex_);
  return Write([&]() -> absl::Status {
    if (const auto row = Find(id, Wanted::kAny); !row.ok()) return row.status();
    return DeleteGrant(*database_, id.Name(), grantee);
  });
}

absl::StatusOr<std::vector<Grant>> RoomStore::GrantsOf(const RoomId& id) {
  const std::lock_guard lock(mutex_);
  return ReadGrants(*database_, id.Name());
}

}  // namespace flatlight
