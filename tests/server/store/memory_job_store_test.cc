// SPDX-License-Identifier: Apache-2.0
#include "server/store/memory_job_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/store/error.h"
#include "tests/support/rendering/fake_clock.h"
#include "tests/support/rendering/test_scene.h"
#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using ::testing::_;
using ::testing::Eq;
using ::testing::HasSubstr;
using testing::IsOk;
using testing::StatusIs;

JobRecord NewJob(JobPhase phase = JobPhase::kQueued) {
  auto spec = std::make_shared<JobSpec>();
  spec->id = JobId::Random();
  spec->scene = std::make_shared<SceneOutline>(*testing::FloorAndLamp({4}));
  auto state = std::make_shared<JobState>();
  state->phase = phase;
  return {spec, state};
}

class MemoryJobStoreTest : public ::testing::Test {
 protected:
  testing::FakeClock clock_;
  MemoryJobStore store_{{.max_jobs = 3}, clock_};
  const RequestKey key_{"me", "CreateJob", "id", "body"};
};

TEST_F(MemoryJobStoreTest, KeepsTheNewestState) {
  const JobRecord job = NewJob();
  ASSERT_THAT(store_.Insert(job, {}, std::nullopt), IsOk());
  auto state = std::make_shared<JobState>();
  state->sequence = 7;
  ASSERT_THAT(store_.Update({job.spec, state}), IsOk());
  EXPECT_EQ(store_.Get(job.spec->id)->state->sequence, 7u);
}

TEST_F(MemoryJobStoreTest, ForgetsWhatIsDeleted) {
  const JobRecord job = NewJob();
  ASSERT_THAT(store_.Insert(job, {}, std::nullopt), IsOk());
  ASSERT_THAT(store_.Delete(job.spec->id), IsOk());
  EXPECT_THAT(store_.Get(job.spec->id), StatusIs(absl::StatusCode::kNotFound, HasSubstr(job.spec->id.Name())));
  EXPECT_THAT(store_.Update({job.spec, job.state}), StatusIs(absl::StatusCode::kNotFound, _));
  EXPECT_THAT(store_.Delete(job.spec->id), StatusIs(absl::StatusCode::kNotFound, _));
}

TEST_F(MemoryJobStoreTest, ListsInPagesNewestFirst) {
  const JobRecord jobs[] = {NewJob(), NewJob(), NewJob()};
  for (const JobRecord& job : jobs) ASSERT_THAT(store_.Insert(job, {}, std::nullopt), IsOk());
  const JobPage first = *store_.List(std::nullopt, std::nullopt, 2);
  ASSERT_EQ(first.jobs.size(), 2u);
  EXPECT_EQ(first.jobs[0].spec->id, jobs[2].spec->id);
  EXPECT_EQ(first.jobs[1].spec->id, jobs[1].spec->id);
  ASSERT_TRUE(first.next_before);
  const JobPage second = *store_.List(std::nullopt, first.next_before, 2);
  ASSERT_EQ(second.jobs.size(), 1u);
  EXPECT_EQ(second.jobs[0].spec->id, jobs[0].spec->id);
  EXPECT_FALSE(second.next_before);
}

TEST_F(MemoryJobStoreTest, ListsTheJobsOfOneOwner) {
  JobRecord jobs[] = {NewJob(), NewJob(), NewJob()};
  for (const int ada : {0, 2}) {
    auto spec = std::make_shared<JobSpec>(*jobs[ada].spec);
    spec->owner = "ada";
    jobs[ada].spec = spec;
  }
  for (const JobRecord& job : jobs) ASSERT_THAT(store_.Insert(job, {}, std::nullopt), IsOk());
  const JobPage first = *store_.List("ada", std::nullopt, 1);
  ASSERT_EQ(first.jobs.size(), 1u);
  EXPECT_EQ(first.jobs[0].spec->id, jobs[2].spec->id);
  const JobPage second = *store_.List("ada", first.next_before, 1);
  ASSERT_EQ(second.jobs.size(), 1u);
  EXPECT_EQ(second.jobs[0].spec->id, jobs[0].spec->id);
  EXPECT_FALSE(second.next_before);
  EXPECT_TRUE(store_.List("bob", std::nullopt, 9)->jobs.empty());
}

TEST_F(MemoryJobStoreTest, SharesJobsWithOthers) {
  const JobRecord jobs[] = {NewJob(), NewJob(), NewJob()};
  const auto ada = Grantee::Of("ada", {"lab-1"});
  for (const JobRecord& job : jobs) ASSERT_THAT(store_.Insert(job, {}, std::nullopt), IsOk());
  const auto share = [&](const JobRecord& job, const char* whom, Access access) {
    return store_.Share(job.spec->id, {*Grantee::Parse(whom), access});
  };
  ASSERT_THAT(share(jobs[0], "group:lab-1", Access::kRead), IsOk());
  ASSERT_THAT(share(jobs[1], "user:bob", Access::kRead), IsOk());
  ASSERT_THAT(share(jobs[2], "user:ada", Access::kControl), IsOk());
  ASSERT_THAT(share(jobs[2], "course", Access::kRead), IsOk());
  const JobPage first = *store_.ListShared(ada, "ada", std::nullopt, 1);
  ASSERT_EQ(first.jobs.size(), 1u);
  EXPECT_EQ(first.jobs[0].spec->id, jobs[2].spec->id);
  const JobPage second = *store_.ListShared(ada, "ada", first.next_before, 1);
  ASSERT_EQ(second.jobs.size(), 1u);
  EXPECT_EQ(second.jobs[0].spec->id, jobs[0].spec->id);
  EXPECT_FALSE(second.next_before);
  EXPECT_TRUE(store_.ListShared(ada, jobs[0].spec->owner, std::nullopt, 9)->jobs.empty());

  EXPECT_EQ(AccessOf(*store_.GrantsOf(jobs[2].spec->id), ada), Access::kControl);
  EXPECT_EQ(AccessOf(*store_.GrantsOf(jobs[1].spec->id), ada), std::nullopt);
  ASSERT_THAT(store_.Unshare(jobs[2].spec->id, *Grantee::Parse("user:ada")), IsOk());
  EXPECT_EQ(AccessOf(*store_.GrantsOf(jobs[2].spec->id), ada), Access::kRead);
  EXPECT_THAT(store_.Unshare(jobs[2].spec->id, *Grantee::Parse("user:ada")), StatusIs(absl::StatusCode::kNotFound, _));
  ASSERT_THAT(store_.Delete(jobs[2].spec->id), IsOk());
  EXPECT_THAT(share(jobs[2], "course", Access::kRead), StatusIs(absl::StatusCode::kNotFound, _));
  EXPECT_TRUE(store_.GrantsOf(jobs[2].spec->id)->empty());
}

TEST_F(MemoryJobStoreTest, DropsTheOldestEndedJobToMakeRoom) {
  const JobRecord running = NewJob();
  const JobRecord old_ended = NewJob(JobPhase::kSucceeded);
  const JobRecord new_ended = NewJob(JobPhase::kFailed);
  for (const JobRecord& job : {running, old_ended, new_ended})
    ASSERT_THAT(store_.Insert(job, {}, std::nullopt), IsOk());
  ASSERT_THAT(store_.Insert(NewJob(), {}, std::nullopt), IsOk());
  EXPECT_THAT(store_.Get(running.spec->id), IsOk());
  EXPECT_THAT(store_.Get(new_ended.spec->id), IsOk());
  EXPECT_THAT(store_.Get(old_ended.spec->id), StatusIs(absl::StatusCode::kNotFound, _));
}

TEST_F(MemoryJobStoreTest, RefusesWhenNoJobHasEnded) {
  for (int i = 0; i < 3; ++i) ASSERT_THAT(store_.Insert(NewJob(), {}, std::nullopt), IsOk());
  const absl::Status refused = store_.Insert(NewJob(), {}, std::nullopt).status();
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("3")));
  ASSERT_TRUE(QuotaViolationOf(refused));
  EXPECT_EQ(QuotaViolationOf(refused)->subject, "max_jobs");
  EXPECT_GT(QuotaViolationOf(refused)->retry_after.count(), 0);
}

TEST_F(MemoryJobStoreTest, RefusesWhatNeedsTooMuchMemory) {
  MemoryJobStore small({.max_bytes = 20'000}, clock_);
  const JobRecord ended = NewJob(JobPhase::kSucceeded);
  ASSERT_THAT(small.Insert(ended, {}, std::nullopt), IsOk());
  JobRecord big = NewJob();
  auto spec = std::make_shared<JobSpec>(*big.spec);
  spec->scene = std::make_shared<SceneOutline>(*testing::FloorAndLamp({1000}));
  big.spec = spec;
  EXPECT_THAT(small.Insert(big, {}, std::nullopt), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("20000")));
  EXPECT_THAT(small.Get(ended.spec->id), IsOk()) << "nothing is dropped for a job that cannot fit";
}

// A result has four points in one channel: a little less than 5000 bytes.
TEST_F(MemoryJobStoreTest, DropsTheResultsThatEndedFirstWhenTheyBecomeTooMany) {
  MemoryJobStore small({.max_ended_bytes = 10'000}, clock_);
  const JobRecord jobs[] = {NewJob(), NewJob(), NewJob(), NewJob()};
  const auto end = [&](int i) { return small.Update({jobs[i].spec, NewJob(JobPhase::kSucceeded).state}); };
  for (const JobRecord& job : jobs) ASSERT_THAT(small.Insert(job, {}, std::nullopt), IsOk());
  ASSERT_THAT(end(2), IsOk());
  ASSERT_THAT(end(1), IsOk());
  for (const JobRecord& job : jobs) ASSERT_THAT(small.Get(job.spec->id), IsOk());
  ASSERT_THAT(end(0), IsOk());
  EXPECT_THAT(small.Get(jobs[2].spec->id), StatusIs(absl::StatusCode::kNotFound, _)) << "the first to end";
  for (const int kept : {0, 1, 3}) EXPECT_THAT(small.Get(jobs[kept].spec->id), IsOk()) << kept;
}

TEST_F(MemoryJobStoreTest, TheNewestResultStaysHoweverLarge) {
  MemoryJobStore small({.max_ended_bytes = 10}, clock_);
  const JobRecord job = NewJob(JobPhase::kSucceeded);
  ASSERT_THAT(small.Insert(job, {}, std::nullopt), IsOk());
  EXPECT_THAT(small.Get(job.spec->id), IsOk());
}

// A scene counts until its job has ended.
TEST_F(MemoryJobStoreTest, AnEndedJobMakesRoomForAnother) {
  MemoryJobStore small({.max_bytes = 12'000}, clock_);
  const JobRecord first = NewJob();
  const JobRecord second = NewJob();
  ASSERT_THAT(small.Insert(first, {}, std::nullopt), IsOk());
  EXPECT_THAT(small.Insert(second, {}, std::nullopt), StatusIs(absl::StatusCode::kResourceExhausted, _));
  ASSERT_THAT(small.Update({first.spec, NewJob(JobPhase::kSucceeded).state}), IsOk());
  ASSERT_THAT(small.Insert(second, {}, std::nullopt), IsOk());
  EXPECT_THAT(small.Get(first.spec->id), IsOk());
}

TEST_F(MemoryJobStoreTest, TheSameRequestFindsItsJob) {
  EXPECT_THAT(*store_.FindRequest(key_), Eq(std::nullopt));
  const JobRecord first = NewJob();
  const JobRecord second = NewJob();
  EXPECT_EQ(store_.Insert(first, {}, key_)->spec->id, first.spec->id);
  EXPECT_EQ(store_.Insert(second, {}, key_)->spec->id, first.spec->id);
  EXPECT_EQ(store_.FindRequest(key_)->value(), first.spec->id);
  EXPECT_THAT(store_.Get(second.spec->id), StatusIs(absl::StatusCode::kNotFound, _));
}

TEST_F(MemoryJobStoreTest, AnotherCallerMayUseTheSameRequestId) {
  const JobRecord second = NewJob();
  ASSERT_THAT(store_.Insert(NewJob(), {}, key_), IsOk());
  RequestKey other = key_;
  other.caller = "you";
  EXPECT_EQ(store_.Insert(second, {}, other)->spec->id, second.spec->id);
}

TEST_F(MemoryJobStoreTest, TheSameRequestIdWithAnotherBodyIsAnError) {
  ASSERT_THAT(store_.Insert(NewJob(), {}, key_), IsOk());
  RequestKey other = key_;
  other.fingerprint = "another body";
  const absl::Status refused = store_.Insert(NewJob(), {}, other).status();
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("request_id id")));
  EXPECT_EQ(ReasonOf(refused), "REQUEST_ID_REUSED");
}

TEST_F(MemoryJobStoreTest, ARequestOfADeletedJobMakesNoSecondOne) {
  const JobRecord job = NewJob();
  ASSERT_THAT(store_.Insert(job, {}, key_), IsOk());
  ASSERT_THAT(store_.Delete(job.spec->id), IsOk());
  EXPECT_THAT(store_.Insert(NewJob(), {}, key_), StatusIs(absl::StatusCode::kNotFound, _));
}

TEST_F(MemoryJobStoreTest, RequestsAreRememberedForADay) {
  ASSERT_THAT(store_.Insert(NewJob(), {}, key_), IsOk());
  clock_.Advance(std::chrono::hours(24));
  EXPECT_NE(*store_.FindRequest(key_), std::nullopt);
  clock_.Advance(std::chrono::seconds(1));
  EXPECT_EQ(*store_.FindRequest(key_), std::nullopt);
}

TEST(JobId, IsARandomUuid) {
  const JobId a = JobId::Random();
  EXPECT_NE(a, JobId::Random());
  EXPECT_EQ(JobId::FromName(a.Name()), a);
  EXPECT_EQ(a.uuid()[14], '4');
}

TEST(JobId, OtherNamesAreRefused) {
  const std::string uuid = JobId::Random().uuid();
  for (const std::string& name :
       {std::string(), uuid, std::string("jobs/"), "jobs/" + uuid + "0", "scenes/" + uuid,
        std::string("jobs/ABCDEF00-0000-4000-8000-000000000000"), "jobs/../" + uuid.substr(3)}) {
    EXPECT_EQ(JobId::FromName(name), std::nullopt) << name;
  }
}

}  // namespace
}  // namespace flatlight
