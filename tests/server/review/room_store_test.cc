// SPDX-License-Identifier: Apache-2.0
#include "server/review/room_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "server/store/error.h"
#include "server/store/schema.h"
#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using ::testing::_;
using testing::IsOk;
using testing::StatusIs;

constexpr Room::Time kNow{std::chrono::milliseconds(1'700'000'000'123)};

class RoomStoreTest : public ::testing::Test {
 protected:
  RoomId NewRoom(const std::string& owner = "ina") {
    const auto room = store_.Create(owner, "lab 3", kNow);
    EXPECT_THAT(room, IsOk());
    return room->id;
  }
  absl::StatusOr<Note> Write(const RoomId& room, const std::string& text, const std::string& request_id = "",
                             const std::string& author = "ada") {
    Note note;
    note.author = author;
    note.text = text;
    note.time = kNow;
    return store_.AddNote(room, note, request_id);
  }
  static RoomStore::Person Person(const std::string& name, const std::vector<std::string>& groups = {}) {
    return {name, Grantee::Of(name, groups)};
  }
  RoomStore store_{{.rooms_per_user = 3, .notes = 250, .all_bytes = 2000}, *NewMemoryDatabase()};
};

TEST_F(RoomStoreTest, NotesComeInOrderOnceAndAfterASequence) {
  const RoomId room = NewRoom();
  for (int i = 0; i < 210; ++i) {
    if (i % 50 == 0) {
      ASSERT_THAT(store_.LookAt(room, {.exposure = i / 10.0}), IsOk());
    }
    ASSERT_THAT(Write(room, std::to_string(i)), IsOk());
  }
  std::uint64_t known = 0;
  int next = 0, updates = 0;
  while (true) {
    const auto update = store_.ReadAfter(room, known);
    ASSERT_THAT(update, IsOk());
    if (update->sequence == known) break;
    ++updates;
    EXPECT_EQ(update->room.view.exposure, 20) << "the state is the newest one, with every batch";
    for (const Note& note : update->notes) {
      EXPECT_EQ(note.text, std::to_string(next++));
      EXPECT_GT(note.sequence, known);
      known = note.sequence;
    }
    EXPECT_EQ(update->more(), next < 210);
    known = update->sequence;
  }
  EXPECT_EQ(next, 210);
  EXPECT_EQ(updates, 3);
  EXPECT_THAT(store_.ReadAfter(room, known + 1), StatusIs(absl::StatusCode::kOutOfRange, _));
}

TEST_F(RoomStoreTest, WhatIsBehindANewViewIsForgotten) {
  const RoomId room = NewRoom();
  const JobId job = JobId::Random();
  ASSERT_THAT(
      store_.LookAt(room,
                    {.job = job, .probe = "floor", .point = 7, .exposure = 1.5, .tone_mapping = ToneMapping::kLinear}),
      IsOk());
  EXPECT_EQ(store_.Get(room)->view.point, 7u);
  const auto other = store_.LookAt(room, {.probe = "wall"});
  EXPECT_EQ(other->room.view.job, job);
  EXPECT_EQ(other->before, job);
  EXPECT_FALSE(other->room.view.point);
  ASSERT_THAT(store_.LookAt(room, {.point = 0}), IsOk());
  const auto next = store_.LookAt(room, {.job = JobId::Random()});
  EXPECT_EQ(next->room.view.probe, "");
  EXPECT_FALSE(next->room.view.point);
  EXPECT_EQ(next->room.view.exposure, 1.5);
  EXPECT_EQ(store_.Get(room)->view.tone_mapping, ToneMapping::kLinear);
  ASSERT_THAT(store_.LookAt(room, {.job = std::optional<JobId>()}), IsOk());
  EXPECT_FALSE(store_.Get(room)->view.job);
}

TEST_F(RoomStoreTest, ARepeatedCallWritesOneNote) {
  const RoomId room = NewRoom();
  const auto first = Write(room, "once", "id");
  ASSERT_THAT(first, IsOk());
  EXPECT_EQ(Write(room, "once", "id")->sequence, first->sequence);
  EXPECT_NE(Write(room, "once", "id", "bob")->sequence, first->sequence) << "another author's is another's";
  ASSERT_THAT(Write(room, "twice"), IsOk());
  ASSERT_THAT(Write(room, "twice"), IsOk());
  EXPECT_EQ(store_.Get(room)->notes, 4u);
}

TEST_F(RoomStoreTest, RoomsAndNotesAreBounded) {
  const RoomId room = NewRoom();
  for (int i = 0; i < 250; ++i) ASSERT_THAT(Write(room, "x"), IsOk());
  EXPECT_EQ(ReasonOf(Write(room, "x").status()), "TOO_MANY_NOTES");
  const RoomId other = NewRoom();
  ASSERT_THAT(Write(other, std::string(1500, 'x')), IsOk());
  EXPECT_EQ(ReasonOf(Write(other, std::string(501, 'x')).status()), "TOO_MANY_NOTES");
  EXPECT_THAT(Write(other, std::string(500, 'x')), IsOk());
  NewRoom();
  EXPECT_EQ(ReasonOf(store_.Create("ina", "one more", kNow).status()), "TOO_MANY_ROOMS");
  NewRoom("eve");
  ASSERT_THAT(store_.Delete(other), IsOk());
  NewRoom();
}

TEST_F(RoomStoreTest, ClosedRoomsAreRead) {
  const RoomId room = NewRoom();
  ASSERT_THAT(Write(room, "before"), IsOk());
  const auto closed = store_.Close(room, kNow);
  ASSERT_THAT(closed, IsOk());
  EXPECT_EQ(closed->close_time, kNow);
  EXPECT_EQ(store_.Close(room, kNow + std::chrono::hours(1))->close_time, kNow);
  EXPECT_EQ(ReasonOf(Write(room, "after").status()), "ROOM_CLOSED");
  EXPECT_EQ(ReasonOf(store_.LookAt(room, {.exposure = 1}).status()), "ROOM_CLOSED");
  EXPECT_EQ(store_.ReadAfter(room, 0)->notes.size(), 1u);
}

TEST_F(RoomStoreTest, ShowsJobsToItsPeopleWhileItIsOpen) {
  const RoomId room = NewRoom();
  const JobId job = JobId::Random();
  ASSERT_THAT(store_.LookAt(room, {.job = job}), IsOk());
  EXPECT_TRUE(*store_.Shows(job, Person("ina")));
  EXPECT_FALSE(*store_.Shows(job, Person("ada", {"lab-1"})));
  ASSERT_THAT(store_.Share(room, {*Grantee::Parse("group:lab-1"), Access::kRead}), IsOk());
  EXPECT_TRUE(*store_.Shows(job, Person("ada", {"lab-1"})));
  EXPECT_FALSE(*store_.Shows(job, Person("ada")));
  EXPECT_FALSE(*store_.Shows(JobId::Random(), Person("ina")));
  ASSERT_THAT(store_.Close(room, kNow), IsOk());
  EXPECT_FALSE(*store_.Shows(job, Person("ina")));
}

TEST_F(RoomStoreTest, ListsRoomsOfOwnersAndMembers) {
  const RoomId rooms[] = {NewRoom(), NewRoom("eve"), NewRoom()};
  ASSERT_THAT(store_.Share(rooms[1], {*Grantee::Parse("user:ina"), Access::kRead}), IsOk());
  ASSERT_THAT(store_.Share(rooms[2], {*Grantee::Parse("course"), Access::kRead}), IsOk());
  const auto list = [&](const std::optional<RoomStore::Person>& of) {
    std::vector<RoomId> ids;
    std::optional<std::uint64_t> before;
    do {
      const auto page = store_.List(of, before, 1);
      EXPECT_THAT(page, IsOk());
      for (const Room& room : page->rooms) ids.push_back(room.id);
      before = page->next_before;
    } while (before);
    return ids;
  };
  EXPECT_EQ(list(Person("ina")), (std::vector<RoomId>{rooms[2], rooms[1], rooms[0]}));
  EXPECT_EQ(list(Person("eve")), (std::vector<RoomId>{rooms[2], rooms[1]}));
  EXPECT_EQ(list(Person("bob")), (std::vector<RoomId>{rooms[2]}));
  EXPECT_EQ(list(std::nullopt).size(), 3u);
}

TEST_F(RoomStoreTest, NothingIsLeftOfADeletedRoom) {
  const RoomId room = NewRoom();
  ASSERT_THAT(Write(room, "text"), IsOk());
  ASSERT_THAT(store_.Share(room, {*Grantee::Parse("course"), Access::kRead}), IsOk());
  ASSERT_THAT(store_.Delete(room), IsOk());
  EXPECT_THAT(store_.Get(room), StatusIs(absl::StatusCode::kNotFound, _));
  EXPECT_THAT(store_.ReadAfter(room, 0), StatusIs(absl::StatusCode::kNotFound, _));
  EXPECT_THAT(Write(room, "text"), StatusIs(absl::StatusCode::kNotFound, _));
  EXPECT_TRUE(store_.GrantsOf(room)->empty());
}

}  // namespace
}  // namespace flatlight
