// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_SCHEDULER_SCHEDULER_FIXTURE_H_
#define FLATLIGHT_TESTS_SUPPORT_SCHEDULER_SCHEDULER_FIXTURE_H_

#include <gtest/gtest.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/execution/thread_pool.h"
#include "server/scheduler/scheduler.h"
#include "server/store/memory_job_store.h"
#include "tests/support/rendering/fake_clock.h"
#include "tests/support/rendering/fake_rendering.h"
#include "tests/support/rendering/test_scene.h"
#include "tests/support/status/status_matchers.h"

namespace flatlight::testing {

// A scheduler of renderings that take kSteps slices, at the pace that the test sets.
class SchedulerFixture : public ::testing::Test {
 protected:
  static constexpr int kSteps = 4;

  ~SchedulerFixture() override { renderings_.Release(); }

  void MakeScheduler(SchedulerOptions options = {}) {
    scheduler_ = std::make_unique<Scheduler>(
        options, store_, pool_, clock_,
        [this](std::shared_ptr<const Scene> scene, const JobSpec& job) { return renderings_.Start(scene, job.plan); },
        [this](const JobId&) {
          const std::lock_guard lock(mutex_);
          changed_.notify_all();
        });
  }

  static std::shared_ptr<const Scene> MakeScene(const std::string& name, const std::vector<std::uint32_t>& counts) {
    SceneDescription description = FloorAndLampDescription(counts);
    description.name = name;
    Diagnostics diagnostics;
    return BuildScene(description, diagnostics);
  }

  absl::StatusOr<JobRecord> SubmitScene(std::shared_ptr<const Scene> scene,
                                        const std::optional<RequestKey>& key = std::nullopt,
                                        const std::string& owner = "", JobClass job_class = JobClass::kInteractive) {
    auto spec = std::make_shared<JobSpec>();
    spec->owner = owner;
    spec->job_class = job_class;
    spec->id = JobId::Random();
    spec->scene = std::make_shared<SceneOutline>(*scene);
    return scheduler_->Submit(spec, std::move(scene), {}, key, quotas_);
  }

  JobId Submit(const std::string& name, const std::string& owner = "", JobClass job_class = JobClass::kInteractive) {
    const auto job = SubmitScene(MakeScene(name, {8}), std::nullopt, owner, job_class);
    EXPECT_THAT(job, IsOk());
    return job->spec->id;
  }

  JobState Await(const JobId& id, const std::function<bool(const JobState&)>& condition) {
    std::unique_lock lock(mutex_);
    JobState state;
    changed_.wait(lock, [&] {
      const auto job = store_.Get(id);
      EXPECT_THAT(job, IsOk());
      if (job.ok()) state = *job->state;
      return !job.ok() || condition(state);
    });
    return state;
  }
  JobState AwaitPhase(const JobId& id, JobPhase phase) {
    return Await(id, [=](const JobState& state) { return state.phase == phase; });
  }
  JobState AwaitEnd(const JobId& id) {
    return Await(id, [](const JobState& state) { return HasEnded(state.phase); });
  }

  // Until all jobs so far are ready for a slice: they are prepared one after the other.
  void AwaitPreparation() { AwaitPhase(Submit("last"), JobPhase::kRunning); }

  Quotas quotas_;  // Of everybody who submits.
  FakeClock clock_;
  ThreadPool pool_{2};
  MemoryJobStore store_{{}, clock_};
  FakeRenderings renderings_{kSteps};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<Scheduler> scheduler_;
};

}  // namespace flatlight::testing

#endif  // FLATLIGHT_TESTS_SUPPORT_SCHEDULER_SCHEDULER_FIXTURE_H_
