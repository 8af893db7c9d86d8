// SPDX-License-Identifier: Apache-2.0
// Review rooms, over real connections of a class.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/store/backup.h"
#include "tests/support/loopback/class_test.h"
#include "tests/support/loopback/loopback_server.h"
#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using grpc::StatusCode;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::IsOk;
using testing::ReasonOf;
using testing::TestContext;

class ReviewTest : public testing::ClassTest {
 protected:
  // A WatchRoom stream, and all that it has brought.
  struct Seen {
    Seen(ReviewTest& test, const std::string& user, const v1::WatchRoomRequest& request) {
      test.Identify(user, context);
      stream = test.server_->review().WatchRoom(&context, request);
    }
    bool Read() {
      v1::WatchRoomResponse update;
      if (!stream->Read(&update)) return false;
      epoch = update.epoch();
      sequence = update.sequence();
      draining = update.draining();
      if (update.has_room()) room = update.room();
      for (const v1::Note& note : update.notes()) notes.push_back(note);
      return true;
    }
    bool ReadTo(std::uint64_t wanted) {
      while (sequence < wanted) {
        if (!Read()) return false;
      }
      return true;
    }
    grpc::Status ReadToEnd() {
      while (Read()) continue;
      return stream->Finish();
    }
    std::vector<std::string> texts() const {
      std::vector<std::string> all;
      for (const v1::Note& note : notes) all.push_back(note.author() + ": " + note.text());
      return all;
    }
    TestContext context;
    std::unique_ptr<grpc::ClientReader<v1::WatchRoomResponse>> stream;
    std::uint64_t epoch = 0;
    std::uint64_t sequence = 0;
    bool draining = false;
    v1::Room room;
    std::vector<v1::Note> notes;
  };

  void SetUp() override {
    Start();
    AddClass();
  }
  template <class Request, class Response>
  grpc::Status Room(const std::string& user, const Request& request, Response& response,
                    grpc::Status (v1::ReviewService::Stub::*rpc)(grpc::ClientContext*, const Request&, Response*)) {
    TestContext context;
    Identify(user, context);
    return (server_->review().*rpc)(&context, request, &response);
  }
  template <class Request, class Response>
  grpc::Status RoomOn(const std::string& user, const std::string& name,
                      grpc::Status (v1::ReviewService::Stub::*rpc)(grpc::ClientContext*, const Request&, Response*)) {
    Request request;
    request.set_name(name);
    Response response;
    return Room(user, request, response, rpc);
  }
  grpc::Status CreateRoom(const std::string& user, std::string title, v1::Room& room) {
    v1::CreateRoomRequest request;
    request.set_title(std::move(title));
    return Room(user, request, room, &v1::ReviewService::Stub::CreateRoom);
  }
  std::string NewRoom(const std::string& user = "ina") {
    v1::Room room;
    EXPECT_TRUE(CreateRoom(user, "lab 3", room).ok());
    return room.name();
  }
  grpc::Status Share(const std::string& user, const std::string& name, const std::string& grantee,
                     v1::Share::Access access = v1::Share::READ) {
    v1::ShareRoomRequest request;
    request.set_name(name);
    request.mutable_share()->set_grantee(grantee);
    request.mutable_share()->set_access(access);
    v1::Room room;
    return Room(user, request, room, &v1::ReviewService::Stub::ShareRoom);
  }
  grpc::Status Unshare(const std::string& user, const std::string& name, const std::string& grantee) {
    v1::UnshareRoomRequest request;
    request.set_name(name);
    request.set_grantee(grantee);
    v1::Room room;
    return Room(user, request, room, &v1::ReviewService::Stub::UnshareRoom);
  }
  grpc::Status Note(const std::string& user, const std::string& name, const std::string& text) {
    v1::AddNoteRequest request;
    request.set_name(name);
    request.set_text(text);
    return Room(user, request, note_, &v1::ReviewService::Stub::AddNote);
  }
  grpc::Status Look(const std::string& user, const std::string& name, const std::string& job) {
    v1::LookAtRequest request;
    request.set_name(name);
    request.set_job(job);
    v1::Room room;
    return Room(user, request, room, &v1::ReviewService::Stub::LookAt);
  }
  grpc::Status GetRoom(const std::string& user, const std::string& name) {
    return RoomOn(user, name, &v1::ReviewService::Stub::GetRoom);
  }
  grpc::Status Close(const std::string& user, const std::string& name) {
    return RoomOn(user, name, &v1::ReviewService::Stub::CloseRoom);
  }
  grpc::Status DeleteRoom(const std::string& user, const std::string& name) {
    return RoomOn(user, name, &v1::ReviewService::Stub::DeleteRoom);
  }
  static v1::WatchRoomRequest From(const std::string& name, std::uint64_t epoch = 0, std::uint64_t sequence = 0) {
    v1::WatchRoomRequest request;
    request.set_name(name);
    request.set_epoch(epoch);
    request.set_after_sequence(sequence);
    return request;
  }
  grpc::Status WatchToEnd(const std::string& user, const std::string& name) {
    return Seen(*this, user, From(name)).ReadToEnd();
  }

  v1::Note note_;
};

TEST_F(ReviewTest, RoomsOfOthersAreNotThere) {
  v1::Room none;
  EXPECT_EQ(ReasonOf(CreateRoom("ada", "mine", none)), "ROLE_TOO_LOW");
  const std::string room = NewRoom();
  const std::string missing = "rooms/00000000-0000-4000-8000-000000000000";
  const auto hidden = [&](const auto& call) {
    const grpc::Status forbidden = call(room), unknown = call(missing);
    EXPECT_EQ(forbidden.error_code(), StatusCode::NOT_FOUND) << forbidden.error_message();
    std::string same = unknown.error_message();
    same.replace(same.find(missing), missing.size(), room);
    EXPECT_EQ(forbidden.error_message(), same);
    EXPECT_EQ(ReasonOf(forbidden), "ROOM_NOT_FOUND");
  };
  for (const char* user : {"ada", "gus"}) {
    hidden([&](const std::string& name) { return GetRoom(user, name); });
    hidden([&](const std::string& name) { return WatchToEnd(user, name); });
    hidden([&](const std::string& name) { return Note(user, name, "hello"); });
    hidden([&](const std::string& name) { return Look(user, name, ""); });
    hidden([&](const std::string& name) { return Share(user, name, "user:ada"); });
    hidden([&](const std::string& name) { return Unshare(user, name, "user:ada"); });
    hidden([&](const std::string& name) { return Close(user, name); });
    hidden([&](const std::string& name) { return DeleteRoom(user, name); });
  }
  const auto listed = [&](const std::string& user) {
    v1::ListRoomsResponse response;
    EXPECT_TRUE(Room(user, v1::ListRoomsRequest(), response, &v1::ReviewService::Stub::ListRooms).ok());
    return response.rooms_size();
  };
  EXPECT_EQ(listed("ada"), 0);
  EXPECT_EQ(listed("ina"), 1);
  ASSERT_TRUE(Share("ina", room, "user:ada").ok());
  EXPECT_EQ(listed("ada"), 1);
  EXPECT_TRUE(GetRoom("ada", room).ok());
  EXPECT_EQ(GetRoom("bob", room).error_code(), StatusCode::NOT_FOUND);
}

TEST_F(ReviewTest, MembersWriteLeadersLookOwnersDecide) {
  const std::string room = NewRoom();
  const std::string job = Create("ada").name();
  ASSERT_TRUE(Share("ina", room, "user:ada").ok());
  ASSERT_TRUE(Share("ina", room, "user:bob", v1::Share::CONTROL).ok());
  EXPECT_TRUE(Note("ada", room, "seen").ok());
  EXPECT_EQ(note_.author(), "ada");
  EXPECT_EQ(ReasonOf(Look("ada", room, job)), "NOT_YOUR_ROOM") << "though the job is hers";
  EXPECT_TRUE(Look("bob", room, "").ok());
  EXPECT_EQ(ReasonOf(Share("bob", room, "user:cyd")), "NOT_YOUR_ROOM");
  EXPECT_EQ(ReasonOf(Close("bob", room)), "NOT_YOUR_ROOM");
  EXPECT_EQ(ReasonOf(DeleteRoom("ada", room)), "NOT_YOUR_ROOM");
  // Shares are for those who may change them.
  v1::GetRoomRequest request;
  request.set_name(room);
  v1::Room told;
  ASSERT_TRUE(Room("ina", request, told, &v1::ReviewService::Stub::GetRoom).ok());
  EXPECT_EQ(told.shares_size(), 2);
  ASSERT_TRUE(Room("bob", request, told, &v1::ReviewService::Stub::GetRoom).ok());
  EXPECT_EQ(told.shares_size(), 0);
  EXPECT_TRUE(DeleteRoom("ina", room).ok());
}

TEST_F(ReviewTest, WhatIsLookedAtIsSeenByTheRoom) {
  const std::string room = NewRoom();
  const std::string first = Create("ada").name(), second = Create("bob", 1'000'000'000).name();
  ASSERT_TRUE(Share("ina", room, "user:cyd", v1::Share::CONTROL).ok());
  ASSERT_TRUE(Share("ina", room, "user:bob", v1::Share::CONTROL).ok());
  EXPECT_EQ(Get("cyd", first).error_code(), StatusCode::NOT_FOUND);
  EXPECT_EQ(Look("cyd", room, first).error_code(), StatusCode::NOT_FOUND) << "who leads shows no strangers' jobs";
  ASSERT_TRUE(Look("ina", room, first).ok());
  EXPECT_TRUE(Watch("cyd", first).ok());
  EXPECT_TRUE(Fetch("cyd", first).ok());
  EXPECT_EQ(ReasonOf(Cancel("cyd", first)), "NOT_YOUR_JOB");
  EXPECT_THAT(List("cyd", true), IsEmpty());
  EXPECT_EQ(ReasonOf(Look("cyd", room, first)), "NOT_YOUR_JOB") << "that she sees it is no leave to show it";
  ASSERT_TRUE(Look("bob", room, second).ok()) << "his own";
  EXPECT_EQ(Get("cyd", first).error_code(), StatusCode::NOT_FOUND);

  TestContext context;
  Identify("cyd", context);
  v1::WatchJobRequest request;
  request.set_name(second);
  const auto watch = server_->render().WatchJob(&context, request);
  v1::WatchJobResponse update;
  ASSERT_TRUE(watch->Read(&update));
  ASSERT_TRUE(Look("ina", room, "").ok());
  while (watch->Read(&update)) continue;
  EXPECT_EQ(watch->Finish().error_code(), StatusCode::NOT_FOUND);
  ASSERT_TRUE(Look("bob", room, second).ok());
  EXPECT_TRUE(Get("cyd", second).ok());
  ASSERT_TRUE(Close("ina", room).ok());
  EXPECT_EQ(Get("cyd", second).error_code(), StatusCode::NOT_FOUND);
}

TEST_F(ReviewTest, TwoWatchersSeeEqualLogs) {
  const std::string room = NewRoom();
  ASSERT_TRUE(Share("ina", room, "course").ok());
  Seen early(*this, "ada", From(room));
  ASSERT_TRUE(early.Read());
  EXPECT_EQ(early.room.title(), "lab 3");
  EXPECT_EQ(early.room.owner(), "ina");
  for (int i = 0; i < 230; ++i) {
    ASSERT_TRUE(Note(i % 2 == 0 ? "bob" : "cyd", room, std::to_string(i)).ok());
    if (i % 100 == 50) {
      ASSERT_TRUE(Look("ina", room, "").ok());
    }
  }
  Seen late(*this, "cyd", From(room));
  ASSERT_TRUE(Close("ina", room).ok());
  EXPECT_TRUE(early.ReadToEnd().ok()) << "a closed room's watch ends well";
  EXPECT_TRUE(late.ReadToEnd().ok());
  ASSERT_EQ(early.notes.size(), 230u);
  EXPECT_EQ(early.notes[7].text(), "7");
  EXPECT_EQ(early.texts(), late.texts());
  EXPECT_EQ(early.room.SerializeAsString(), late.room.SerializeAsString());
  EXPECT_TRUE(early.room.has_close_time());
  std::set<std::uint64_t> sequences;
  for (const v1::Note& note : late.notes) sequences.insert(note.sequence());
  EXPECT_EQ(sequences.size(), 230u);
  EXPECT_EQ(ReasonOf(Note("bob", room, "too late")), "ROOM_CLOSED");
}

TEST_F(ReviewTest, WatchesResumeWhereTheyEnded) {
  const std::string room = NewRoom();
  ASSERT_TRUE(Share("ina", room, "user:ada").ok());
  ASSERT_TRUE(Note("ina", room, "one").ok());
  std::uint64_t epoch = 0, sequence = 0;
  {
    Seen watch(*this, "ada", From(room));
    ASSERT_TRUE(watch.ReadTo(note_.sequence()));
    EXPECT_THAT(watch.texts(), ElementsAre("ina: one"));
    epoch = watch.epoch;
    sequence = watch.sequence;
    watch.context.TryCancel();
  }
  ASSERT_TRUE(Note("ada", room, "two").ok());
  {
    Seen watch(*this, "ada", From(room, epoch, sequence));
    ASSERT_TRUE(watch.ReadTo(note_.sequence()));
    EXPECT_THAT(watch.texts(), ElementsAre("ada: two"));
    sequence = watch.sequence;
    // Over a restart.
    std::thread stopping([&] { server_.reset(); });
    while (watch.Read()) continue;
    EXPECT_TRUE(watch.draining);
    EXPECT_EQ(watch.stream->Finish().error_code(), StatusCode::UNAVAILABLE);
    stopping.join();
  }
  Start();
  ASSERT_TRUE(Note("ina", room, "three").ok());
  {
    Seen watch(*this, "ada", From(room, epoch, sequence));
    ASSERT_TRUE(watch.ReadTo(note_.sequence()));
    EXPECT_THAT(watch.texts(), ElementsAre("ina: three"));
  }
  Seen anew(*this, "ada", From(room, epoch + 2, sequence));
  ASSERT_TRUE(anew.ReadTo(note_.sequence()));
  EXPECT_THAT(anew.texts(), ElementsAre("ina: one", "ada: two", "ina: three")) << "of another epoch all comes again";
  EXPECT_EQ(ReasonOf(Seen(*this, "ada", From(room, epoch, note_.sequence() + 1)).ReadToEnd()), "SEQUENCE_AHEAD");
  // Without news it is told at once that it is connected.
  Seen idle(*this, "ada", From(room, epoch, note_.sequence()));
  ASSERT_TRUE(idle.Read());
  EXPECT_EQ(idle.sequence, note_.sequence());
  EXPECT_FALSE(idle.room.has_create_time());
}

TEST_F(ReviewTest, AfterABackupItIsAnotherEpoch) {
  const std::string room = NewRoom();
  const std::string data = folder_.path() + "/data";
  Seen before(*this, "ina", From(room));
  ASSERT_TRUE(before.Read());
  ASSERT_THAT(BackUp(data, folder_.path() + "/backup"), IsOk());
  before.context.TryCancel();
  server_.reset();
  ASSERT_THAT(RestoreBackup(folder_.path() + "/backup", folder_.path() + "/restored"), IsOk());
  ServerOptions options;
  options.data = folder_.path() + "/restored";
  server_ = std::make_unique<testing::LoopbackServer>(options);
  Seen after(*this, "ina", From(room));
  ASSERT_TRUE(after.Read());
  EXPECT_EQ(after.sequence, before.sequence);
  EXPECT_NE(after.epoch, before.epoch);
  EXPECT_LT(after.epoch, std::uint64_t{1} << 53);
}

TEST_F(ReviewTest, WithTheShareTheWatchEnds) {
  const std::string room = NewRoom();
  ASSERT_TRUE(Share("ina", room, "user:ada").ok());
  Seen watch(*this, "ada", From(room)), own(*this, "ina", From(room));
  ASSERT_TRUE(watch.Read());
  ASSERT_TRUE(own.Read());
  ASSERT_TRUE(Unshare("ina", room, "user:ada").ok());
  EXPECT_EQ(watch.ReadToEnd().error_code(), StatusCode::NOT_FOUND);
  ASSERT_TRUE(DeleteRoom("ina", room).ok());
  EXPECT_EQ(own.ReadToEnd().error_code(), StatusCode::NOT_FOUND);
}

TEST_F(ReviewTest, MistakesAreRefused) {
  const std::string room = NewRoom();
  v1::Room none;
  EXPECT_EQ(CreateRoom("ina", "", none).error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(CreateRoom("ina", std::string(201, 'x'), none).error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(Note("ina", room, "").error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(Note("ina", room, std::string(2001, 'x')).error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(Note("ina", room, std::string(2000, 'x')).ok());
  EXPECT_EQ(Note("ina", "jobs/1", "x").error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(Look("ina", room, "job").error_code(), StatusCode::INVALID_ARGUMENT);
  const auto refused = [&](const auto& set) {
    v1::LookAtRequest request;
    request.set_name(room);
    set(request);
    return Room("ina", request, none, &v1::ReviewService::Stub::LookAt).error_code() == StatusCode::INVALID_ARGUMENT;
  };
  EXPECT_TRUE(refused([](auto& request) { request.set_exposure(32.5); }));
  EXPECT_TRUE(refused([](auto& request) { request.set_exposure(std::nan("")); }));
  EXPECT_TRUE(refused([](auto& request) { request.set_probe(std::string(257, 'p')); }));
  EXPECT_TRUE(refused([](auto& request) { request.set_tone_mapping(static_cast<v1::ToneMapping>(9)); }));
  v1::AddNoteRequest request;
  request.set_name(room);
  request.set_text("here");
  request.mutable_place()->set_x(1);
  EXPECT_EQ(Room("ina", request, note_, &v1::ReviewService::Stub::AddNote).error_code(), StatusCode::INVALID_ARGUMENT);
  request.mutable_place()->set_y(-0.5);
  ASSERT_TRUE(Room("ina", request, note_, &v1::ReviewService::Stub::AddNote).ok());
  EXPECT_EQ(note_.place().y(), -0.5);
}

}  // namespace
}  // namespace flatlight
