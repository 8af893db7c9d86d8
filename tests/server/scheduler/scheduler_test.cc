// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/scheduler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <new>
#include <stdexcept>

#include "server/scheduler/metered_executor.h"
#include "server/store/error.h"
#include "tests/support/scheduler/scheduler_fixture.h"

namespace flatlight {
namespace {

using ::testing::_;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::IsOk;
using testing::StatusIs;

using SchedulerTest = testing::SchedulerFixture;

TEST_F(SchedulerTest, RunsAJobToItsEnd) {
  MakeScheduler();
  const JobState state = AwaitEnd(Submit("a"));
  EXPECT_EQ(state.phase, JobPhase::kSucceeded);
  EXPECT_EQ(state.end_reason, EndReason::kSamplesDone);
  EXPECT_TRUE(state.start_time && state.end_time);
  ASSERT_NE(state.field, nullptr);
  EXPECT_EQ(state.field->probes[0].irradiance, std::vector<double>(8, kSteps));
}

TEST_F(SchedulerTest, JobsTakeTurns) {
  MakeScheduler();
  renderings_.Hold();
  const JobId a = Submit("a");
  AwaitPhase(a, JobPhase::kRunning);
  const JobId b = Submit("b");
  AwaitPreparation();
  renderings_.Release();
  AwaitEnd(a);
  AwaitEnd(b);
  std::vector<std::string> slices = renderings_.slices();
  std::erase(slices, "last");
  EXPECT_THAT(slices, ElementsAre("a", "b", "a", "b", "a", "b", "a", "b"));
}

TEST_F(SchedulerTest, ANewcomerGoesBeforeThoseThatHaveSomethingToShow) {
  MakeScheduler();
  renderings_.Hold();
  const JobId a = Submit("a");
  AwaitPhase(a, JobPhase::kRunning);
  const JobId b = Submit("b");
  AwaitPreparation();  // Else both steps may be a's.
  renderings_.Allow(2);
  Await(b, [](const JobState& state) { return state.field != nullptr; });
  Submit("c");  // While the next slice waits for its step, or just before it.
  AwaitPreparation();
  renderings_.Release();
  AwaitEnd(b);
  std::vector<std::string> slices = renderings_.slices();
  slices.resize(4);
  EXPECT_THAT(slices, ::testing::Contains("c"));
}

TEST_F(SchedulerTest, PublishesTheFirstPictureAtOnceAndLaterOnesNowAndThen) {
  MakeScheduler();
  // The clock stands still, so only the first and the last picture are due: QUEUED 1, RUNNING 2, 3, 4.
  EXPECT_EQ(AwaitEnd(Submit("a")).sequence, 4u);
}

TEST_F(SchedulerTest, PublishesWhenTheIntervalHasPassed) {
  SchedulerOptions options;
  renderings_.set_on_step([&](auto&&...) { clock_.Advance(options.publish_interval); });
  MakeScheduler(options);
  EXPECT_EQ(AwaitEnd(Submit("a")).sequence, 2u + kSteps);
}

TEST_F(SchedulerTest, SaysWhichPointsChanged) {
  SchedulerOptions options;
  renderings_.set_on_step([&](auto&&...) { clock_.Advance(options.publish_interval); });
  MakeScheduler(options);
  const auto job = SubmitScene(MakeScene("a", {FieldVersions::kPoints + 1, 3}));
  ASSERT_THAT(job, IsOk());
  const JobState state = AwaitEnd(job->spec->id);
  // The first probe changed with every step, the second only with the first.
  EXPECT_THAT(state.versions.changed, ElementsAre(ElementsAre(state.sequence, state.sequence), ElementsAre(3)));
}

TEST_F(SchedulerTest, CancelStopsASliceAndKeepsWhatIsThere) {
  MakeScheduler();
  renderings_.Hold();
  const JobId a = Submit("a");
  renderings_.Allow(1);
  Await(a, [](const JobState& state) { return state.field != nullptr; });
  const auto cancelled = scheduler_->Cancel(a);
  ASSERT_THAT(cancelled, IsOk());
  EXPECT_EQ(cancelled->state->phase, JobPhase::kCancelled);
  EXPECT_FALSE(cancelled->state->end_reason);
  EXPECT_EQ(cancelled->state->field->probes[0].irradiance[0], 1);
  EXPECT_THAT(renderings_.slices(), ElementsAre("a"));
}

TEST_F(SchedulerTest, AnEndedJobCannotBeCancelled) {
  MakeScheduler();
  const JobId a = Submit("a");
  const std::uint64_t sequence = AwaitEnd(a).sequence;
  const auto cancelled = scheduler_->Cancel(a);
  ASSERT_THAT(cancelled, IsOk());
  EXPECT_EQ(cancelled->state->phase, JobPhase::kSucceeded);
  EXPECT_EQ(cancelled->state->sequence, sequence);
}

TEST_F(SchedulerTest, JobsBeyondTheLimitWaitAndCanBeCancelledThere) {
  SchedulerOptions options;
  options.max_running_jobs = 1;
  MakeScheduler(options);
  renderings_.Hold();
  const JobId a = Submit("a");
  const JobId b = Submit("b");
  const JobId c = Submit("c");
  AwaitPhase(a, JobPhase::kRunning);
  EXPECT_EQ(store_.Get(b)->state->phase, JobPhase::kQueued);
  EXPECT_EQ(scheduler_->Cancel(b)->state->phase, JobPhase::kCancelled);
  renderings_.Release();
  EXPECT_EQ(AwaitEnd(c).phase, JobPhase::kSucceeded);
  EXPECT_THAT(renderings_.slices(), ElementsAre("a", "a", "a", "a", "c", "c", "c", "c"));
}

TEST_F(SchedulerTest, AFailureOnAPoolThreadEndsItsJobOnly) {
  renderings_.set_on_step([](const std::string& scene, int, Executor& executor, const Cancellation&) {
    executor.ParallelFor(8, 2, [&](std::size_t i) {
      if (scene == "bad" && i == 7) throw std::runtime_error("the roof leaks");
      if (scene == "big" && i == 7) throw std::bad_alloc();
    });
  });
  MakeScheduler();
  const JobId bad = Submit("bad");
  const JobId big = Submit("big");
  const JobId good = Submit("good");
  const JobState state = AwaitEnd(bad);
  EXPECT_EQ(state.phase, JobPhase::kFailed);
  EXPECT_THAT(state.error, StatusIs(absl::StatusCode::kInternal, HasSubstr("the roof leaks")));
  EXPECT_THAT(AwaitEnd(big).error, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("memory")));
  EXPECT_EQ(AwaitEnd(good).phase, JobPhase::kSucceeded);
}

// Its pictures are no numbers.
class BrokenRendering final : public Rendering {
 public:
  void Advance(Executor&, const Cancellation&, const Clock&, Clock::Duration) override {}
  bool done() const override { return true; }
  EndReason end_reason() const override { return EndReason::kSamplesDone; }
  RenderProgress Progress() const override { return {}; }
  std::shared_ptr<const Field> Snapshot() const override {
    auto field = std::make_shared<Field>();
    field->probes.resize(1);
    field->probes[0].irradiance.assign(8, 1);
    field->probes[0].gradient.assign(8, 0);
    field->probes[0].gradient[5] = -std::numeric_limits<double>::infinity();
    return field;
  }
};

TEST_F(SchedulerTest, InfinitiesAndNansAreAFailureAndNotShown) {
  scheduler_ = std::make_unique<Scheduler>(
      SchedulerOptions(), store_, pool_, clock_, [](auto&&...) { return std::make_unique<BrokenRendering>(); },
      [this](const JobId&) {
        const std::lock_guard lock(mutex_);
        changed_.notify_all();
      });
  const JobState state = AwaitEnd(Submit("a"));
  EXPECT_EQ(state.phase, JobPhase::kFailed);
  const std::string probe = MakeScene("a", {8})->probes()[0].name;
  EXPECT_THAT(state.error, StatusIs(absl::StatusCode::kInternal,
                                    HasSubstr("probe \"" + probe + "\": gradient at point 5 is infinite")));
  EXPECT_EQ(state.field, nullptr);
}

TEST_F(SchedulerTest, DeletingARunningJobStopsIt) {
  MakeScheduler();
  renderings_.Hold();
  const JobId a = Submit("a");
  AwaitPhase(a, JobPhase::kRunning);
  EXPECT_THAT(scheduler_->Delete(a), IsOk());
  EXPECT_THAT(store_.Get(a), StatusIs(absl::StatusCode::kNotFound, _));
  const JobId b = Submit("b");
  renderings_.Allow(kSteps);
  EXPECT_EQ(AwaitEnd(b).phase, JobPhase::kSucceeded);
  EXPECT_THAT(renderings_.slices(), ElementsAre("b", "b", "b", "b"));
}

TEST_F(SchedulerTest, AnEndedJobKeepsItsResultButNotItsScene) {
  SchedulerOptions options;
  options.max_running_jobs = 1;
  MakeScheduler(options);
  renderings_.Hold();
  std::shared_ptr<const Scene> scene = MakeScene("a", {8});
  const std::weak_ptr<const Scene> watched = scene;
  const auto done = SubmitScene(scene);
  const auto cancelled_while_waiting = SubmitScene(std::move(scene));
  ASSERT_THAT(done, IsOk());
  ASSERT_THAT(cancelled_while_waiting, IsOk());
  EXPECT_FALSE(watched.expired());
  ASSERT_THAT(scheduler_->Cancel(cancelled_while_waiting->spec->id), IsOk());
  renderings_.Release();
  AwaitEnd(done->spec->id);
  scheduler_->Stop();  // Nothing is on its way to be freed any more.
  EXPECT_TRUE(watched.expired());
  EXPECT_NE(store_.Get(done->spec->id)->state->field, nullptr);
}

TEST_F(SchedulerTest, TheSameRequestMakesOneJob) {
  MakeScheduler();
  const RequestKey key{"me", "CreateJob", "id", "fingerprint"};
  const auto first = SubmitScene(MakeScene("a", {8}), key);
  const auto second = SubmitScene(MakeScene("a", {8}), key);
  ASSERT_THAT(first, IsOk());
  ASSERT_THAT(second, IsOk());
  EXPECT_EQ(first->spec->id, second->spec->id);
  AwaitEnd(first->spec->id);
  EXPECT_EQ(renderings_.slices().size(), kSteps);
}

TEST_F(SchedulerTest, StopCancelsAllAndRefusesMore) {
  SchedulerOptions options;
  options.max_running_jobs = 1;
  MakeScheduler(options);
  renderings_.Hold();
  const JobId a = Submit("a");
  const JobId b = Submit("b");
  AwaitPhase(a, JobPhase::kRunning);
  scheduler_->Stop();
  EXPECT_EQ(store_.Get(a)->state->phase, JobPhase::kCancelled);
  EXPECT_EQ(store_.Get(b)->state->phase, JobPhase::kCancelled);
  EXPECT_THAT(SubmitScene(MakeScene("c", {8})), StatusIs(absl::StatusCode::kUnavailable, _));
}

TEST_F(SchedulerTest, CountsTheProcessorTimeOfAllThreads) {
  std::atomic<std::int64_t> spent = 0;
  renderings_.set_on_step([&](const std::string&, int, Executor& executor, const Cancellation&) {
    executor.ParallelFor(8, 2, [&](std::size_t) {
      const std::int64_t start = ThreadCpuNanoseconds();
      while (ThreadCpuNanoseconds() - start < 1'000'000) {
      }
      spent += ThreadCpuNanoseconds() - start;
    });
  });
  MakeScheduler();
  const double cpu_seconds = AwaitEnd(Submit("a")).cpu_seconds;
  EXPECT_GE(cpu_seconds, 1e-9 * static_cast<double>(spent));
  // Nothing else takes a tenth of it.
  EXPECT_LT(cpu_seconds, 1.1e-9 * static_cast<double>(spent) + 0.005);
}

}  // namespace
}  // namespace flatlight
