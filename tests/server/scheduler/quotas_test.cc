// SPDX-License-Identifier: Apache-2.0
// What becomes of jobs whose owner has had what one may have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <mutex>

#include "server/quota/cpu_ledger.h"
#include "server/scheduler/scheduler.h"
#include "server/store/error.h"
#include "tests/support/scheduler/scheduler_fixture.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using testing::IsOk;
using testing::StatusIs;

// 23:00:00 UTC.
constexpr CpuLedger::WallTime kLate{std::chrono::hours(24 * 20'000 + 23)};
constexpr double kDay = 1000;  // s of processor time: no job here needs as many.

class QuotasTest : public testing::SchedulerFixture {
 protected:
  ~QuotasTest() override {
    renderings_.Release();
    scheduler_.reset();
  }
  void Make(std::size_t max_running_jobs = 200) {
    SchedulerOptions options;
    options.max_running_jobs = max_running_jobs;
    options.ledger = &ledger_;
    options.day_interval = std::chrono::milliseconds(1);
    quotas_.cpu_seconds = kDay;
    MakeScheduler(options);
  }
  void SetTime(CpuLedger::WallTime time) {
    const std::lock_guard lock(time_mutex_);
    time_ = time;
  }
  JobState AwaitRest(const JobId& id) {
    return Await(
        id, [](const JobState& state) { return state.queue && state.queue->reason == QueuePlace::Reason::kDayUsedUp; });
  }
  // A job of ada's that has begun when her day is used up.
  JobId SubmitAndLetRest() {
    renderings_.Hold();
    const JobId id = Submit("a", "ada");
    AwaitPreparation();
    ledger_.Charge("ada", kDay);
    renderings_.Allow(2);
    AwaitRest(id);
    renderings_.Release();
    return id;
  }
  // A job of a work that others may share.
  JobId SubmitWork(const std::string& owner) {
    auto spec = std::make_shared<JobSpec>();
    auto scene = MakeScene("shared", {8});
    spec->owner = owner;
    spec->id = JobId::Random();
    spec->work_key = "the same";
    spec->scene = std::make_shared<SceneOutline>(*scene);
    EXPECT_THAT(scheduler_->Submit(spec, std::move(scene), {}, std::nullopt, quotas_), IsOk());
    return spec->id;
  }

  std::mutex time_mutex_;
  CpuLedger::WallTime time_ = kLate;
  CpuLedger ledger_{nullptr, {.now = [this] {
                      const std::lock_guard lock(time_mutex_);
                      return time_;
                    }}};
};

TEST_F(QuotasTest, AUserHasSoManyJobsAndNoMore) {
  quotas_.jobs = 2;
  MakeScheduler();
  renderings_.Hold();
  const JobId first = Submit("a", "ada");
  Submit("b", "ada");
  const auto refused = SubmitScene(MakeScene("c", {8}), std::nullopt, "ada");
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("2 of your jobs")));
  const auto violation = QuotaViolationOf(refused.status());
  EXPECT_EQ(violation->subject, "max_jobs_per_user");
  EXPECT_EQ(violation->use->used, 2);
  EXPECT_EQ(violation->use->allowed, 2);
  EXPECT_EQ(scheduler_->JobsOf("ada"), 2u);
  EXPECT_EQ(scheduler_->JobsOf("bob"), 0u);
  EXPECT_THAT(SubmitScene(MakeScene("c", {8}), std::nullopt, "bob"), IsOk());
  ASSERT_THAT(scheduler_->Cancel(first), IsOk());
  EXPECT_THAT(SubmitScene(MakeScene("c", {8}), std::nullopt, "ada"), IsOk());
}

TEST_F(QuotasTest, WorkIsCharged) {
  Make();
  AwaitEnd(Submit("a", "ada"));
  const double first = ledger_.UsedToday("ada");
  EXPECT_GT(first, 0);
  AwaitEnd(Submit("b", "ada"));
  EXPECT_GT(ledger_.UsedToday("ada"), first);
  EXPECT_EQ(ledger_.UsedToday("bob"), 0);
}

TEST_F(QuotasTest, WhoseDayIsUsedUpRestsUntilTomorrow) {
  Make();
  renderings_.Hold();
  const JobId a = Submit("a", "ada");
  AwaitPhase(a, JobPhase::kRunning);
  AwaitPreparation();
  ledger_.Charge("ada", kDay);
  renderings_.Allow(2);
  const JobState resting = AwaitRest(a);
  EXPECT_EQ(resting.phase, JobPhase::kQueued);
  EXPECT_EQ(resting.queue->expected_start, kLate + std::chrono::hours(1));

  const auto refused = SubmitScene(MakeScene("c", {8}), std::nullopt, "ada");
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("allowed: 1000 s a day")));
  EXPECT_EQ(ReasonOf(refused.status()), "PROCESSOR_TIME_USED_UP");
  const auto violation = QuotaViolationOf(refused.status());
  EXPECT_EQ(violation->retry_after, std::chrono::hours(1));
  EXPECT_GE(violation->use->used, kDay);
  EXPECT_EQ(violation->use->allowed, kDay);

  renderings_.Release();
  EXPECT_EQ(AwaitEnd(Submit("b", "bob")).phase, JobPhase::kSucceeded) << "others go on";
  SetTime(kLate + std::chrono::minutes(59));
  AwaitEnd(Submit("b", "bob"));
  EXPECT_FALSE(HasEnded(store_.Get(a)->state->phase));
  SetTime(kLate + std::chrono::hours(1));
  EXPECT_EQ(AwaitEnd(a).phase, JobPhase::kSucceeded);
  EXPECT_THAT(SubmitScene(MakeScene("c", {8}), std::nullopt, "ada"), IsOk());
}

TEST_F(QuotasTest, JustBelowADayGoesOn) {
  Make();
  ledger_.Charge("ada", kDay - 100);
  EXPECT_EQ(AwaitEnd(Submit("a", "ada")).phase, JobPhase::kSucceeded);
}

TEST_F(QuotasTest, JobsThatWaitForAPlaceSayThatTheyRest) {
  Make(2);
  renderings_.Hold();
  const JobId first = Submit("a", "ada");
  AwaitPhase(first, JobPhase::kRunning);
  const JobId second = Submit("a", "ada");
  EXPECT_EQ(store_.Get(second)->state->phase, JobPhase::kQueued);
  AwaitPreparation();
  ledger_.Charge("ada", kDay);
  renderings_.Allow(4);
  AwaitRest(first);
  AwaitRest(second);
  renderings_.Release();
  ASSERT_THAT(scheduler_->Cancel(first), IsOk());
  EXPECT_EQ(AwaitEnd(Submit("b", "bob")).phase, JobPhase::kSucceeded);
  EXPECT_EQ(store_.Get(second)->state->phase, JobPhase::kQueued) << "it gets no place";
  SetTime(kLate + std::chrono::hours(1));
  EXPECT_EQ(AwaitEnd(second).phase, JobPhase::kSucceeded);
}

TEST_F(QuotasTest, RestingJobsArePausedAndResumedAndCancelled) {
  Make();
  renderings_.Hold();
  const JobId a = Submit("a", "ada");
  const JobId b = Submit("b", "ada");
  AwaitPreparation();
  ledger_.Charge("ada", kDay);
  renderings_.Allow(2);
  AwaitRest(a);
  AwaitRest(b);
  renderings_.Release();
  ASSERT_THAT(scheduler_->Pause(a), IsOk());
  const auto paused = store_.Get(a);
  EXPECT_EQ(paused->state->phase, JobPhase::kPaused);
  EXPECT_FALSE(paused->state->queue);
  ASSERT_THAT(scheduler_->Resume(a), IsOk());
  AwaitRest(a);
  ASSERT_THAT(scheduler_->Cancel(b), IsOk());
  EXPECT_EQ(AwaitEnd(b).phase, JobPhase::kCancelled);
  SetTime(kLate + std::chrono::hours(1));
  EXPECT_EQ(AwaitEnd(a).phase, JobPhase::kSucceeded);
}

TEST_F(QuotasTest, NobodyRestsBecauseOfTheOneWhoDoesTheSameWork) {
  Make();
  renderings_.Hold();
  const JobId leader = SubmitWork("ada");
  AwaitPhase(leader, JobPhase::kRunning);
  const JobId follower = SubmitWork("bob");
  AwaitPreparation();
  ledger_.Charge("ada", kDay);
  renderings_.Allow(2);
  AwaitRest(leader);
  renderings_.Release();
  EXPECT_EQ(AwaitEnd(follower).phase, JobPhase::kSucceeded);
  EXPECT_EQ(AwaitEnd(SubmitWork("eve")).phase, JobPhase::kSucceeded);
  EXPECT_FALSE(HasEnded(store_.Get(leader)->state->phase));
}

TEST_F(QuotasTest, WhoGetsMoreGoesOn) {
  Make();
  const JobId a = SubmitAndLetRest();
  quotas_.cpu_seconds.reset();
  EXPECT_THAT(SubmitScene(MakeScene("c", {8}), std::nullopt, "ada"), IsOk());
  EXPECT_EQ(AwaitEnd(a).phase, JobPhase::kSucceeded);
}

TEST_F(QuotasTest, AServerThatGoesDownWaitsForNoTomorrow) {
  Make();
  const JobId a = SubmitAndLetRest();
  scheduler_->Stop();
  EXPECT_EQ(store_.Get(a)->state->phase, JobPhase::kCancelled);
}

}  // namespace
}  // namespace flatlight
