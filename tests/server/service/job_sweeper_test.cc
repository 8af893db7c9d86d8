// SPDX-License-Identifier: Apache-2.0
#include "server/service/job_sweeper.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <set>
#include <thread>

#include "server/store/memory_job_store.h"
#include "tests/support/rendering/fake_clock.h"
#include "tests/support/rendering/test_scene.h"

namespace flatlight {
namespace {

class JobSweeperTest : public ::testing::Test {
 protected:
  // Ended an hour ago.
  JobId AddEnded(JobClass job_class) {
    auto spec = std::make_shared<JobSpec>();
    spec->id = JobId::Random();
    spec->job_class = job_class;
    spec->scene = scene_;
    auto state = std::make_shared<JobState>();
    state->phase = JobPhase::kSucceeded;
    state->end_time = now_ - std::chrono::hours(1);
    EXPECT_TRUE(store_.Insert({spec, state}, {}, std::nullopt).ok());
    return spec->id;
  }
  std::size_t Left() { return store_.List(std::nullopt, std::nullopt, 10'000)->jobs.size(); }

  const WallTime now_ = std::chrono::system_clock::now();
  const std::shared_ptr<const SceneOutline> scene_ = std::make_shared<SceneOutline>(*testing::FloorAndLamp({4}));
  testing::FakeClock clock_;
  MemoryJobStore store_{{}, clock_};
};

TEST_F(JobSweeperTest, AllGoButWhatSomebodyNeedsAndWhatIsKeptLonger) {
  std::set<JobId> needed;
  for (int i = 0; i < 350; ++i) {
    const JobId id = AddEnded(i % 10 == 9 ? JobClass::kGraded : JobClass::kInteractive);
    if (i % 3 == 0 && i % 10 != 9) needed.insert(id);
  }
  std::atomic<bool> wanted = true;
  std::atomic<int> removed = 0;
  Retention retention;
  ASSERT_TRUE(retention.Set("interactive=30m").ok());
  ASSERT_TRUE(retention.Set("graded=2h").ok());
  JobSweeper sweeper({.retention = retention,
                      .interval = std::chrono::milliseconds(1),
                      .most_at_once = 120,
                      .now = [this] { return now_; }},
                     store_,
                     {.is_needed = [&](const JobId& id) { return wanted && needed.count(id) > 0; },
                      .remove = [&](const JobId& id) { return store_.Delete(id); },
                      .removed = [&](const JobSpec& spec) { removed += spec.job_class == JobClass::kInteractive; }});
  while (Left() > 35 + needed.size()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(Left(), 35 + needed.size());
  for (const JobId& id : needed) EXPECT_TRUE(store_.Get(id).ok());
  wanted = false;
  while (Left() > 35) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  sweeper.Close();
  EXPECT_EQ(Left(), 35u);
  EXPECT_EQ(removed, 315);
}

}  // namespace
}  // namespace flatlight
