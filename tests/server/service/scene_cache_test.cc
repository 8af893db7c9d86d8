// SPDX-License-Identifier: Apache-2.0
#include "server/service/scene_cache.h"

#include <gtest/gtest.h>

#include "server/service/scene_source.h"
#include "server/store/error.h"
#include "server/store/memory_scene_store.h"
#include "tests/support/rendering/fake_clock.h"
#include "tests/support/rendering/test_scene.h"

namespace flatlight {
namespace {

TEST(SceneCache, TheSceneUsedLongestAgoGoesFirst) {
  const auto scene = testing::FloorAndLamp({4});
  SceneCache cache(2 * SceneCache::EstimateBytes(*scene));
  cache.Put("ada", "a", scene);
  cache.Put("ada", "b", scene);
  EXPECT_EQ(cache.Get("ada", "a"), scene);
  cache.Put("ada", "c", scene);
  EXPECT_EQ(cache.Get("ada", "b"), nullptr);
  EXPECT_EQ(cache.Get("ada", "a"), scene);
  EXPECT_EQ(cache.Get("ada", "c"), scene);
  cache.Drop("a");
  EXPECT_EQ(cache.Get("ada", "a"), nullptr);
  cache.Put("ada", "d", scene);
  EXPECT_EQ(cache.Get("ada", "c"), scene) << "there was room";
}

TEST(SceneCache, ASceneLargerThanAllDrivesNoneOut) {
  const auto small = testing::FloorAndLamp({4});
  SceneCache cache(SceneCache::EstimateBytes(*small));
  cache.Put("ada", "small", small);
  cache.Put("ada", "large", testing::FloorAndLamp({1000}));
  EXPECT_EQ(cache.Get("ada", "large"), nullptr);
  EXPECT_EQ(cache.Get("ada", "small"), small);
}

TEST(SceneCache, NobodyFindsWhatAnotherOneHasBuilt) {
  const auto scene = testing::FloorAndLamp({4});
  SceneCache cache(4 * SceneCache::EstimateBytes(*scene));
  cache.Put("ada", "a", scene);
  EXPECT_EQ(cache.Get("bob", "a"), nullptr);
  cache.Put("bob", "a", scene);
  EXPECT_EQ(cache.Get("bob", "a"), scene);
  cache.Drop("a");
  EXPECT_EQ(cache.Get("ada", "a"), nullptr);
  EXPECT_EQ(cache.Get("bob", "a"), nullptr);
}

class LoadSceneTest : public ::testing::Test {
 protected:
  LoadSceneTest() {
    EXPECT_TRUE(store_.Upload(caller_.name, hash_, text_.size(), 0, text_).ok());
    source_.set_name("scenes/" + hash_);
  }
  // Lets `phases` phases begin.
  absl::StatusOr<std::shared_ptr<const Scene>> Load(int phases) {
    Diagnostics diagnostics;
    auto scene = LoadScene(
        source_, {caller_, store_, cache_, Limits()},
        [&] { return --phases < 0 ? MakeError(absl::StatusCode::kCancelled, "STOPPED", "") : absl::OkStatus(); },
        diagnostics);
    EXPECT_TRUE(diagnostics.empty());
    return scene;
  }

  const std::string text_ = R"({"name":"room","plane":{
      "materials":[{"name":"grey","lambertian":{"reflectance":[0.5]}}],
      "curves":[{"name":"floor","segment":{"a":{"x":0,"y":0},"b":{"x":1,"y":0}},"material":"grey"}]},
      "probes":[{"name":"floor","curve":"floor","count":3}]})";
  const std::string hash_ = Sha256Of(text_);
  const Caller caller_{"ada", Role::kStudent};
  testing::FakeClock clock_;
  MemorySceneStore store_{{}, clock_};
  SceneCache cache_{1u << 20};
  v1::SceneSource source_;
};

TEST_F(LoadSceneTest, AnUploadIsBuiltOnce) {
  const auto first = Load(3);
  ASSERT_TRUE(first.ok()) << first.status();
  ASSERT_NE(*first, nullptr);
  EXPECT_EQ(*Load(3), *first);
}

TEST_F(LoadSceneTest, StopsBeforeThePhaseThatNobodyWants) {
  EXPECT_EQ(ReasonOf(Load(0).status()), "STOPPED") << "before reading";
  EXPECT_EQ(ReasonOf(Load(1).status()), "STOPPED") << "before building";
  EXPECT_EQ(cache_.Get(caller_.name, hash_), nullptr);
  EXPECT_EQ(ReasonOf(Load(2).status()), "STOPPED") << "before what follows";
  EXPECT_NE(cache_.Get(caller_.name, hash_), nullptr) << "the next call need not begin anew";
}

}  // namespace
}  // namespace flatlight
