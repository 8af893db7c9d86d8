// SPDX-License-Identifier: Apache-2.0
// Whose turn it is, and what those are told who wait.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "server/scheduler/scheduler.h"
#include "server/store/error.h"
#include "tests/support/scheduler/scheduler_fixture.h"

namespace flatlight {
namespace {

using ::testing::_;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::IsOk;
using testing::StatusIs;

class FairnessTest : public testing::SchedulerFixture {
 protected:
  absl::StatusOr<JobRecord> PauseDuringSlices(const JobId& id) {
    std::atomic<bool> paused = false;
    std::thread allow([&] { renderings_.AllowUntil(paused); });
    auto job = scheduler_->Pause(id);
    paused = true;
    allow.join();
    return job;
  }
};

std::size_t FirstOf(const std::vector<std::string>& slices, const std::string& scene) {
  return static_cast<std::size_t>(std::ranges::find(slices, scene) - slices.begin());
}

TEST_F(FairnessTest, AThousandJobsOfOneDelayAnothersFirstPictureByASlice) {
  MakeScheduler();
  renderings_.Hold();
  for (int i = 0; i < 1000; ++i) Submit("many", "ada");
  const JobId one = Submit("one", "bob");
  AwaitPhase(one, JobPhase::kRunning);
  AwaitPreparation();
  ASSERT_THAT(renderings_.slices(), ElementsAre());
  renderings_.Allow(3);
  Await(one, [](const JobState& state) { return state.field != nullptr; });
  std::vector<std::string> slices = renderings_.slices();
  std::erase(slices, "last");             // Of a third one.
  EXPECT_LE(FirstOf(slices, "one"), 1u);  // A slice of ada's was under way.
  renderings_.Release();
  scheduler_->Stop();
}

TEST_F(FairnessTest, PlacesAreLeftForWhoComes) {
  SchedulerOptions options;
  options.max_running_jobs = 8;
  MakeScheduler(options);
  renderings_.Hold();
  constexpr int kJobs = 20;
  std::vector<JobId> ada;
  ada.reserve(kJobs);
  for (int i = 0; i < kJobs; ++i) ada.push_back(Submit("many", "ada"));
  AwaitPhase(ada[3], JobPhase::kRunning);
  EXPECT_EQ(store_.Get(ada[4])->state->phase, JobPhase::kQueued);
  AwaitPhase(Submit("one", "bob"), JobPhase::kRunning);
  AwaitPhase(Submit("one", "eve"), JobPhase::kRunning);
  renderings_.Release();
  for (const JobId& id : ada) EXPECT_EQ(AwaitEnd(id).phase, JobPhase::kSucceeded);
}

TEST_F(FairnessTest, APlaceIsLeftForAPictureBesideOnesOwnRegrading) {
  SchedulerOptions options;
  options.max_running_jobs = 8;
  MakeScheduler(options);
  renderings_.Hold();
  std::vector<JobId> regrading;
  for (int i = 0; i < 8; ++i) regrading.push_back(Submit("many", "ada", JobClass::kRegrade));
  AwaitPhase(regrading[3], JobPhase::kRunning);
  EXPECT_EQ(store_.Get(regrading[4])->state->phase, JobPhase::kQueued);
  AwaitPhase(Submit("graded", "ada", JobClass::kGraded), JobPhase::kRunning);
  AwaitPhase(Submit("picture", "ada", JobClass::kInteractive), JobPhase::kRunning);
  EXPECT_EQ(store_.Get(regrading[4])->state->phase, JobPhase::kQueued);
  renderings_.Release();
  for (const JobId& id : regrading) EXPECT_EQ(AwaitEnd(id).phase, JobPhase::kSucceeded);
}

TEST_F(FairnessTest, ThoseWhoWaitKnowWhyAndHowLong) {
  SchedulerOptions options;
  options.max_running_jobs = 2;
  MakeScheduler(options);
  renderings_.Hold();
  Submit("a", "ada");
  const JobId own = Submit("b", "ada");
  const JobState waits = Await(own, [](const JobState& state) { return state.queue.has_value(); });
  EXPECT_EQ(waits.queue->reason, QueuePlace::Reason::kOwnJobs);
  EXPECT_EQ(waits.queue->ahead, 0u);
  EXPECT_FALSE(waits.queue->expected_start);
  clock_.Advance(options.queue_interval);
  Submit("c", "bob");
  const JobId full = Submit("d", "bob");
  clock_.Advance(options.queue_interval);
  const JobId later = Submit("e", "bob");
  const JobState behind = Await(later, [](const JobState& state) { return state.queue.has_value(); });
  EXPECT_EQ(behind.queue->reason, QueuePlace::Reason::kServerFull);
  EXPECT_EQ(behind.queue->ahead, 2u);
  EXPECT_LE(store_.Get(full)->state->queue->ahead, 1u);
  renderings_.Release();
  const JobState ended = AwaitEnd(later);
  EXPECT_EQ(ended.phase, JobPhase::kSucceeded);
  EXPECT_FALSE(ended.queue);
}

TEST_F(FairnessTest, AForecastComesFromThePaceOfLate) {
  AdmissionPace pace;
  EXPECT_FALSE(pace.Wait(0));
  Clock::Time now{};
  pace.NoteWaiting(now);
  now += std::chrono::seconds(3);
  pace.NoteAdmission(now);
  EXPECT_EQ(*pace.Wait(0), std::chrono::seconds(3));
  EXPECT_EQ(*pace.Wait(4), std::chrono::seconds(15));
  // Idle hours are not a pace.
  pace.NoteNobodyWaits();
  now += std::chrono::hours(1);
  pace.NoteAdmission(now);
  EXPECT_EQ(*pace.Wait(0), std::chrono::seconds(3));
}

TEST_F(FairnessTest, InteractiveWorkComesBeforeARegrade) {
  MakeScheduler();
  renderings_.Hold();
  const JobId first = Submit("first", "ada", JobClass::kRegrade);
  AwaitPhase(first, JobPhase::kRunning);
  AwaitPhase(Submit("regrade", "ada", JobClass::kRegrade), JobPhase::kRunning);
  const JobId looked_at = Submit("looked at", "ada");
  AwaitPhase(looked_at, JobPhase::kRunning);
  AwaitPreparation();
  renderings_.Allow(1 + 2 * kSteps + 1);  // One is under way, and one of eight is for the others.
  AwaitEnd(looked_at);
  // Until that end: what came after it is of no concern.
  std::vector<std::string> slices = renderings_.slices();
  slices.erase(std::find(slices.rbegin(), slices.rend(), "looked at").base(), slices.end());
  EXPECT_LE(std::ranges::count(slices, "regrade"), 1) << ::testing::PrintToString(slices);
  renderings_.Release();
}

TEST_F(FairnessTest, APausedJobRestsAndItsTimeToo) {
  constexpr int kManySteps = 1000;
  renderings_.set_total_steps(kManySteps);
  MakeScheduler();
  renderings_.Hold();
  const JobId a = Submit("a");
  renderings_.Allow(2);
  Await(a, [](const JobState& state) { return state.field != nullptr; });
  const auto paused = PauseDuringSlices(a);
  ASSERT_THAT(paused, IsOk());
  EXPECT_EQ(paused->state->phase, JobPhase::kPaused);
  const std::size_t slices = renderings_.slices().size();
  const double elapsed = paused->state->elapsed_seconds;
  clock_.Advance(std::chrono::hours(1));
  renderings_.Release();
  EXPECT_EQ(AwaitEnd(Submit("b")).phase, JobPhase::kSucceeded);
  EXPECT_EQ(std::ranges::count(renderings_.slices(), "a"), static_cast<std::ptrdiff_t>(slices));
  ASSERT_THAT(scheduler_->Resume(a), IsOk());
  const JobState ended = AwaitEnd(a);
  EXPECT_EQ(ended.phase, JobPhase::kSucceeded);
  EXPECT_EQ(ended.elapsed_seconds, elapsed);
  EXPECT_EQ(std::ranges::count(renderings_.slices(), "a"), kManySteps);
  EXPECT_THAT(scheduler_->Pause(a), StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("has ended")));
  EXPECT_THAT(scheduler_->Resume(a), StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("has ended")));
  EXPECT_THAT(scheduler_->Pause(JobId::Random()), StatusIs(absl::StatusCode::kNotFound, _));
}

TEST_F(FairnessTest, APausedJobCanWaitResumeAndBeCancelled) {
  SchedulerOptions options;
  options.max_running_jobs = 1;
  MakeScheduler(options);
  renderings_.Hold();
  const JobId running = Submit("running");
  AwaitPhase(running, JobPhase::kRunning);
  const JobId waits = Submit("waits");
  const JobId next = Submit("next");
  EXPECT_EQ(scheduler_->Pause(waits)->state->phase, JobPhase::kPaused);
  renderings_.Release();
  EXPECT_EQ(AwaitEnd(next).phase, JobPhase::kSucceeded);  // It went by.
  EXPECT_EQ(store_.Get(waits)->state->phase, JobPhase::kPaused);
  ASSERT_THAT(scheduler_->Resume(waits), IsOk());
  EXPECT_EQ(AwaitEnd(waits).phase, JobPhase::kSucceeded);

  renderings_.set_total_steps(1000);
  renderings_.Hold();
  const JobId last = Submit("last one");
  renderings_.Allow(1);
  Await(last, [](const JobState& state) { return state.field != nullptr; });
  ASSERT_THAT(PauseDuringSlices(last), IsOk());
  const auto cancelled = scheduler_->Cancel(last);
  ASSERT_THAT(cancelled, IsOk());
  EXPECT_EQ(cancelled->state->phase, JobPhase::kCancelled);
  EXPECT_NE(cancelled->state->field, nullptr);
}

}  // namespace
}  // namespace flatlight
