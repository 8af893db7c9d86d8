// SPDX-License-Identifier: Apache-2.0
#include "server/store/memory_scene_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/store/error.h"
#include "tests/support/rendering/fake_clock.h"
#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using ::testing::_;
using ::testing::HasSubstr;
using testing::IsOk;
using testing::StatusIs;
using enum absl::StatusCode;

constexpr char kOwner[] = "ada";

class MemorySceneStoreTest : public ::testing::Test {
 protected:
  // Uploads all of `text` at once.
  absl::StatusOr<std::uint64_t> UploadAll(const std::string& text) {
    return store_.Upload(kOwner, Sha256Of(text), text.size(), 0, text);
  }

  testing::FakeClock clock_;
  MemorySceneStore store_{{.max_scene_bytes = 100, .max_total_bytes = 150, .max_scenes = 3, .max_uploads = 2}, clock_};
  const std::string text_ = "{\"name\": \"a scene\"}";
  const std::string hash_ = Sha256Of(text_);
};

TEST(Sha256, AgreesWithThePublishedExample) {
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(Sha256Of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(MemorySceneStoreTest, TakesAFileInPieces) {
  EXPECT_EQ(*store_.Upload(kOwner, hash_, text_.size(), 0, ""), 0u);
  EXPECT_EQ(*store_.Upload(kOwner, hash_, text_.size(), 0, text_.substr(0, 5)), 5u);
  EXPECT_EQ(*store_.Upload(kOwner, hash_, text_.size(), 0, ""), 5u) << "a call without data asks";
  EXPECT_THAT(store_.Get(hash_), StatusIs(kNotFound, _)) << "not complete";
  EXPECT_EQ(*store_.Upload(kOwner, hash_, text_.size(), 0, text_.substr(0, 5)), 5u) << "said twice";
  EXPECT_EQ(*store_.Upload(kOwner, hash_, text_.size(), 5, text_.substr(5)), text_.size());
  EXPECT_EQ(*store_.Get(hash_)->bytes, text_);
  EXPECT_EQ(*store_.Upload(kOwner, hash_, text_.size(), 0, text_), text_.size()) << "all is there already";
}

TEST_F(MemorySceneStoreTest, ThePlaceOfAPieceMustBeRight) {
  ASSERT_THAT(store_.Upload(kOwner, hash_, text_.size(), 0, text_.substr(0, 5)), IsOk());
  EXPECT_THAT(store_.Upload(kOwner, hash_, text_.size(), 3, text_.substr(3, 5)),
              StatusIs(kOutOfRange, HasSubstr("5 bytes are there")));
  EXPECT_THAT(store_.Upload(kOwner, hash_, text_.size(), 5, text_), StatusIs(kInvalidArgument, HasSubstr("missing")));
  EXPECT_THAT(store_.Upload(kOwner, hash_, text_.size() + 1, 5, "x"),
              StatusIs(kInvalidArgument, HasSubstr("total_bytes")));
}

TEST_F(MemorySceneStoreTest, OtherBytesThanTheHashSaysAreThrownAway) {
  const std::string other(text_.size(), 'x');
  EXPECT_THAT(store_.Upload(kOwner, hash_, text_.size(), 0, other),
              StatusIs(kInvalidArgument, HasSubstr(Sha256Of(other))));
  EXPECT_THAT(store_.Get(hash_), StatusIs(kNotFound, _));
  EXPECT_THAT(UploadAll(text_), IsOk()) << "and the right ones are taken";
}

TEST_F(MemorySceneStoreTest, RefusesBadHashesAndSizes) {
  EXPECT_THAT(store_.Upload(kOwner, "abc", 3, 0, "abc"), StatusIs(kInvalidArgument, HasSubstr("sha256")));
  EXPECT_THAT(store_.Upload(kOwner, hash_, 0, 0, ""), StatusIs(kInvalidArgument, HasSubstr("total_bytes is 0")));
  EXPECT_THAT(store_.Upload(kOwner, hash_, 101, 0, "x"), StatusIs(kInvalidArgument, HasSubstr("100")));
}

TEST_F(MemorySceneStoreTest, AnOwnersRoomIsLimited) {
  const auto upload = [&](const std::string& owner, const std::string& text, std::uint64_t elsewhere,
                          std::size_t bytes = 100) {
    return store_.Upload(owner, Sha256Of(text), text.size(), 0, text.substr(0, bytes), SceneRoom{50, elsewhere});
  };
  const std::string a(30, 'a');
  const std::string b(20, 'b');
  ASSERT_THAT(upload("ada", a, 0), IsOk());
  EXPECT_EQ(store_.BytesOf("ada"), 30u);
  EXPECT_EQ(store_.BytesOf("bob"), 0u);
  const auto refused = upload("ada", b, 1);
  EXPECT_THAT(refused, StatusIs(kResourceExhausted, HasSubstr("hold 31 bytes, and 20 more are wanted; allowed: 50")));
  EXPECT_EQ(QuotaViolationOf(refused.status())->use->used, 31);
  ASSERT_THAT(upload("bob", a, 20), IsOk()) << "it is kept once, and counts for both";
  ASSERT_THAT(store_.Disown("ada", Sha256Of(a)), IsOk());
  EXPECT_EQ(store_.BytesOf("ada"), 0u);
  EXPECT_EQ(store_.BytesOf("bob"), 30u);
  ASSERT_THAT(store_.Delete(Sha256Of(a)), IsOk());
  EXPECT_EQ(store_.BytesOf("bob"), 0u);
  EXPECT_THAT(upload("ada", b, 30), IsOk()) << "to the last byte";

  // What was begun counts too, until it has been idle for a minute and room is needed.
  ASSERT_THAT(upload("ada", a, 0, 25), IsOk());
  EXPECT_EQ(store_.BytesOf("ada"), 45u);
  const std::string c(10, 'c');
  EXPECT_THAT(upload("ada", c, 0), StatusIs(kResourceExhausted, _));
  clock_.Advance(std::chrono::seconds(61));
  EXPECT_THAT(upload("ada", c, 0), IsOk());
  EXPECT_EQ(store_.BytesOf("ada"), 30u);
  EXPECT_THAT(store_.Upload("ada", Sha256Of(c), c.size(), 0, std::string(10, 'x')), IsOk()) << "it is there";
  const std::string d(10, 'd');
  EXPECT_THAT(store_.Upload("ada", Sha256Of(d), d.size(), 0, std::string(10, 'x')), StatusIs(kInvalidArgument, _));
  EXPECT_EQ(store_.BytesOf("ada"), 30u) << "what was thrown away does not count";
}

TEST_F(MemorySceneStoreTest, AllScenesTogetherAreLimited) {
  ASSERT_THAT(UploadAll(std::string(90, 'a')), IsOk());
  const auto refused = UploadAll(std::string(61, 'b'));
  EXPECT_THAT(refused, StatusIs(kResourceExhausted, HasSubstr("150")));
  EXPECT_TRUE(QuotaViolationOf(refused.status()));
  ASSERT_THAT(store_.Delete(Sha256Of(std::string(90, 'a'))), IsOk());
  EXPECT_THAT(UploadAll(std::string(61, 'b')), IsOk());
}

TEST_F(MemorySceneStoreTest, AnIdleUploadGivesWay) {
  ASSERT_THAT(store_.Upload(kOwner, Sha256Of("first"), 5, 0, "fi"), IsOk());
  ASSERT_THAT(store_.Upload(kOwner, Sha256Of("second"), 6, 0, "se"), IsOk());
  EXPECT_THAT(store_.Upload(kOwner, Sha256Of("third"), 5, 0, "th"),
              StatusIs(kResourceExhausted, HasSubstr("2 uploads")));
  clock_.Advance(std::chrono::seconds(30));
  ASSERT_THAT(store_.Upload(kOwner, Sha256Of("second"), 6, 2, "co"), IsOk());
  clock_.Advance(std::chrono::seconds(31));
  EXPECT_THAT(store_.Upload(kOwner, Sha256Of("third"), 5, 0, "th"), IsOk());
  EXPECT_EQ(*store_.Upload(kOwner, Sha256Of("first"), 5, 0, ""), 0u);
  EXPECT_EQ(*store_.Upload(kOwner, Sha256Of("second"), 6, 0, ""), 4u);
}

TEST_F(MemorySceneStoreTest, ListsNewestFirst) {
  for (const char* text : {"a", "b", "c"}) ASSERT_THAT(UploadAll(text), IsOk());
  store_.SetTitle(kOwner, Sha256Of("c"), "the third");
  const ScenePage first = store_.List(std::nullopt, std::nullopt, 2);
  ASSERT_EQ(first.scenes.size(), 2u);
  EXPECT_EQ(first.scenes[0].title, "the third");
  const ScenePage second = store_.List(std::nullopt, first.next_before, 2);
  ASSERT_EQ(second.scenes.size(), 1u);
  EXPECT_EQ(*second.scenes[0].bytes, "a");
  EXPECT_FALSE(second.next_before);
  EXPECT_THAT(UploadAll("d"), StatusIs(kResourceExhausted, HasSubstr("3 scenes")));
}

TEST_F(MemorySceneStoreTest, BytesOfSeveralOwnersAreKeptOnceUntilTheLastGoes) {
  const std::string large(70, 'a');  // Two of them, and 50 bytes, are more than fits in.
  const std::string hash = Sha256Of(large);
  ASSERT_THAT(UploadAll(large), IsOk());
  EXPECT_EQ(*store_.Upload("bob", hash, 70, 0, large.substr(0, 50)), 50u) << "as if nobody had it";
  EXPECT_EQ(*store_.Upload("bob", hash, 70, 50, large.substr(50)), 70u);
  ASSERT_THAT(UploadAll(std::string(50, 'b')), IsOk());
  ASSERT_THAT(store_.Disown(kOwner, hash), IsOk());
  EXPECT_FALSE(store_.Owns(kOwner, hash));
  EXPECT_THAT(store_.Get(hash), IsOk());
  EXPECT_THAT(store_.Disown(kOwner, hash), StatusIs(kNotFound, _));
  ASSERT_THAT(store_.Disown("bob", hash), IsOk());
  EXPECT_THAT(store_.Get(hash), StatusIs(kNotFound, _));
  EXPECT_THAT(UploadAll(std::string(90, 'c')), IsOk()) << "there is room again";
}

TEST_F(MemorySceneStoreTest, PositionsOfOnesOwnScenesTellNothingOfOthers) {
  for (const char* text : {"a", "b", "c"}) {
    ASSERT_THAT(store_.Upload("bob", Sha256Of(text), 1, 0, text), IsOk());
  }
  ASSERT_THAT(store_.Upload(kOwner, Sha256Of("d"), 1, 0, "d"), StatusIs(kResourceExhausted, _));
  ASSERT_THAT(store_.Disown("bob", Sha256Of("c")), IsOk());
  ASSERT_THAT(store_.Upload(kOwner, Sha256Of("d"), 1, 0, "d"), IsOk());
  ASSERT_THAT(store_.Delete(Sha256Of("b")), IsOk());
  ASSERT_THAT(store_.Upload(kOwner, Sha256Of("a"), 1, 0, "a"), IsOk());
  const ScenePage first = store_.List(kOwner, std::nullopt, 1);
  ASSERT_EQ(first.scenes.size(), 1u);
  EXPECT_EQ(*first.scenes[0].bytes, "a") << "its newest, whoever had it before";
  EXPECT_EQ(first.next_before, 2u);
  const ScenePage second = store_.List(kOwner, first.next_before, 1);
  ASSERT_EQ(second.scenes.size(), 1u);
  EXPECT_EQ(*second.scenes[0].bytes, "d");
  EXPECT_FALSE(second.next_before);
}

}  // namespace
}  // namespace flatlight
