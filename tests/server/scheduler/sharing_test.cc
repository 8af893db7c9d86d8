// SPDX-License-Identifier: Apache-2.0
// Jobs that do the same work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "server/scheduler/scheduler.h"
#include "tests/support/scheduler/scheduler_fixture.h"

namespace flatlight {
namespace {

using ::testing::Each;
using testing::IsOk;
using ::testing::SizeIs;

class SharingTest : public testing::SchedulerFixture {
 protected:
  JobId SubmitEqual(const std::string& name, JobClass job_class = JobClass::kInteractive,
                    const std::string& work_key = "work") {
    auto scene = MakeScene(name, {8});
    auto spec = std::make_shared<JobSpec>();
    spec->owner = name;
    spec->job_class = job_class;
    spec->work_key = work_key;
    spec->id = JobId::Random();
    spec->scene = std::make_shared<SceneOutline>(*scene);
    const auto job = scheduler_->Submit(spec, std::move(scene), {}, std::nullopt);
    EXPECT_THAT(job, IsOk());
    return job->spec->id;
  }
  // While slices may be held up.
  template <class Call>
  void Meanwhile(const Call& call) {
    std::atomic<bool> done = false;
    std::thread allow([&] { renderings_.AllowUntil(done); });
    call();
    done = true;
    allow.join();
  }
  void AwaitPicture(const JobId& id) {
    Await(id, [](const JobState& state) { return state.field != nullptr; });
  }
};

TEST_F(SharingTest, EqualJobsAreRenderedOnce) {
  MakeScheduler();
  renderings_.Hold();
  const JobId first = SubmitEqual("first");
  AwaitPhase(first, JobPhase::kRunning);
  const JobId second = SubmitEqual("second");
  EXPECT_EQ(store_.Get(second)->state->phase, JobPhase::kRunning);
  renderings_.Allow(1);
  AwaitPicture(second);
  EXPECT_TRUE(store_.Get(second)->state->shared_work);
  const JobId third = SubmitEqual("third");
  EXPECT_EQ(store_.Get(third)->state->field, store_.Get(first)->state->field);
  renderings_.Release();
  const JobState led = AwaitEnd(first);
  for (const JobId& id : {second, third}) {
    const JobState followed = AwaitEnd(id);
    EXPECT_EQ(followed.phase, JobPhase::kSucceeded);
    EXPECT_EQ(followed.field, led.field);
    EXPECT_EQ(followed.end_reason, led.end_reason);
    EXPECT_EQ(followed.cpu_seconds, 0);
    EXPECT_GE(followed.sequence, 2u);
  }
  EXPECT_FALSE(led.shared_work);
  const JobId later = SubmitEqual("later");
  EXPECT_EQ(store_.Get(later)->state->phase, JobPhase::kSucceeded);
  EXPECT_EQ(store_.Get(later)->state->field, led.field);
  EXPECT_THAT(renderings_.slices(), SizeIs(kSteps));
  EXPECT_THAT(renderings_.slices(), Each("first"));
}

TEST_F(SharingTest, OtherWorkIsNotShared) {
  MakeScheduler();
  AwaitEnd(SubmitEqual("a", JobClass::kInteractive, "one"));
  AwaitEnd(SubmitEqual("b", JobClass::kInteractive, "two"));
  AwaitEnd(SubmitEqual("c", JobClass::kInteractive, ""));
  const JobState own = AwaitEnd(SubmitEqual("d", JobClass::kInteractive, ""));
  EXPECT_FALSE(own.shared_work);
  EXPECT_THAT(renderings_.slices(), SizeIs(4 * kSteps));
}

TEST_F(SharingTest, WhatWasDeletedIsRenderedAgain) {
  MakeScheduler();
  const JobId first = SubmitEqual("first");
  AwaitEnd(first);
  EXPECT_THAT(scheduler_->Delete(first), IsOk());
  const JobState again = AwaitEnd(SubmitEqual("second"));
  EXPECT_EQ(again.phase, JobPhase::kSucceeded);
  EXPECT_FALSE(again.shared_work);
  EXPECT_THAT(renderings_.slices(), SizeIs(2 * kSteps));
}

TEST_F(SharingTest, WhoFollowsGoesOnWithoutTheOther) {
  // So many that they are not all taken before the call comes through.
  renderings_.set_total_steps(2000);
  for (const bool pause : {false, true}) {
    MakeScheduler();
    renderings_.Hold();
    const std::string key = pause ? "paused" : "cancelled";
    const JobId first = SubmitEqual("first", JobClass::kInteractive, key);
    const JobId second = SubmitEqual("second", JobClass::kInteractive, key);
    const JobId third = SubmitEqual("third", JobClass::kInteractive, key);
    renderings_.Allow(1);
    AwaitPicture(third);
    const std::uint64_t seen = store_.Get(third)->state->sequence;
    Meanwhile([&] { EXPECT_THAT(pause ? scheduler_->Pause(first) : scheduler_->Cancel(first), IsOk()); });
    renderings_.Release();
    EXPECT_EQ(AwaitEnd(second).phase, JobPhase::kSucceeded);
    const JobState ended = AwaitEnd(third);
    EXPECT_EQ(ended.phase, JobPhase::kSucceeded);
    EXPECT_GT(ended.sequence, seen);
    EXPECT_FALSE(AwaitEnd(second).shared_work);
    EXPECT_TRUE(ended.shared_work);
    EXPECT_EQ(ended.field, AwaitEnd(second).field);
    if (!pause) continue;
    EXPECT_EQ(store_.Get(first)->state->phase, JobPhase::kPaused);
    EXPECT_THAT(scheduler_->Resume(first), IsOk());
    EXPECT_EQ(AwaitEnd(first).phase, JobPhase::kSucceeded);
  }
}

TEST_F(SharingTest, WhoFollowsCanRestAndEnd) {
  MakeScheduler();
  renderings_.Hold();
  const JobId first = SubmitEqual("first");
  const JobId second = SubmitEqual("second");
  const JobId third = SubmitEqual("third");
  renderings_.Allow(1);
  AwaitPicture(third);
  EXPECT_THAT(scheduler_->Cancel(second), IsOk());
  EXPECT_EQ(store_.Get(second)->state->phase, JobPhase::kCancelled);
  EXPECT_THAT(scheduler_->Pause(third), IsOk());
  EXPECT_EQ(store_.Get(third)->state->phase, JobPhase::kPaused);
  const auto picture = store_.Get(third)->state->field;
  renderings_.Release();
  EXPECT_EQ(AwaitEnd(first).phase, JobPhase::kSucceeded);
  EXPECT_EQ(store_.Get(third)->state->field, picture);
  EXPECT_THAT(scheduler_->Resume(third), IsOk());
  EXPECT_EQ(AwaitEnd(third).phase, JobPhase::kSucceeded);
}

TEST_F(SharingTest, NobodyWaitsForWhatIsLessUrgent) {
  MakeScheduler();
  renderings_.Hold();
  const JobId regrade = SubmitEqual("regrade", JobClass::kRegrade);
  AwaitPhase(regrade, JobPhase::kRunning);
  const JobId picture = SubmitEqual("picture", JobClass::kInteractive);
  const JobId graded = SubmitEqual("graded", JobClass::kGraded);
  renderings_.Release();
  EXPECT_FALSE(AwaitEnd(regrade).shared_work);
  EXPECT_FALSE(AwaitEnd(picture).shared_work);
  EXPECT_TRUE(AwaitEnd(graded).shared_work);
}

TEST_F(SharingTest, AServerThatGoesDownLeavesNobodyBehind) {
  MakeScheduler();
  renderings_.Hold();
  const JobId first = SubmitEqual("first");
  const JobId second = SubmitEqual("second");
  Meanwhile([&] { scheduler_->Stop(); });
  EXPECT_EQ(store_.Get(first)->state->phase, JobPhase::kCancelled);
  EXPECT_EQ(store_.Get(second)->state->phase, JobPhase::kCancelled);
}

}  // namespace
}  // namespace flatlight
