// SPDX-License-Identifier: Apache-2.0
#include "server/service/job_messages.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "flatlight/v1/render_service.pb.h"
#include "tests/support/rendering/test_scene.h"

namespace flatlight {
namespace {

JobRecord NewJob() {
  auto spec = std::make_shared<JobSpec>();
  spec->id = JobId::Random();
  spec->owner = "ada";
  spec->scene = std::make_shared<SceneOutline>(*testing::FloorAndLamp({4}));
  return {std::move(spec), std::make_shared<JobState>()};
}

JobRecord InState(const JobRecord& job, double samples) {
  auto state = std::make_shared<JobState>(*job.state);
  state->progress.samples = samples;
  return {job.spec, std::move(state)};
}

v1::Job Told(const grpc::Slice& bytes) {
  v1::Job job;
  EXPECT_TRUE(job.ParseFromArray(bytes.begin(), static_cast<int>(bytes.size())));
  return job;
}

TEST(JobMessages, AStateIsSerialisedOnce) {
  JobMessages messages;
  const JobRecord job = NewJob();
  const JobRecord in_store = job;
  const grpc::Slice first = messages.Of(job);
  EXPECT_EQ(Told(first).name(), job.spec->id.Name());
  EXPECT_EQ(Told(first).owner(), "ada");
  EXPECT_EQ(messages.Of(job).begin(), first.begin());
}

TEST(JobMessages, EachJobAndEachOfItsStatesIsToldAsItIs) {
  JobMessages messages;
  const JobRecord job = NewJob();
  const JobRecord other = NewJob();
  messages.Of(job);
  EXPECT_EQ(Told(messages.Of(other)).name(), other.spec->id.Name());
  // Those before are gone by then, and memory is used again.
  for (double samples = 1; samples <= 1000; ++samples) {
    EXPECT_EQ(Told(messages.Of(InState(job, samples))).progress().samples(), samples);
  }
  EXPECT_EQ(Told(messages.Of(job)).progress().samples(), 0);
}

TEST(JobMessages, ManyJobsAreToldThoughNotAllAreRemembered) {
  JobMessages messages;
  for (int i = 0; i < 10'000; ++i) {
    const JobRecord job = NewJob();
    ASSERT_EQ(Told(messages.Of(job)).name(), job.spec->id.Name());
  }
}

TEST(JobMessages, WhatIsDeletedOrReadFromTheDiskIsNotRemembered) {
  JobMessages messages;
  const JobRecord job = NewJob();
  EXPECT_NE(messages.Of(job).begin(), messages.Of(job).begin()) << "nobody else has its state";
  const JobRecord in_store = job;
  const grpc::Slice first = messages.Of(job);
  EXPECT_EQ(messages.Of(job).begin(), first.begin());
  messages.Forget(job.spec->id);
  EXPECT_NE(messages.Of(job).begin(), first.begin());
}

// Of jobs that are gone there is room for as many as there may be; one that is there is not forgotten for them.
TEST(JobMessages, ThoseThatAreGoneMakeRoom) {
  JobMessages messages;
  const JobRecord job = NewJob();
  const JobRecord in_store = job;
  const grpc::Slice first = messages.Of(job);
  for (int i = 0; i < 20'000; ++i) {
    const JobRecord gone = NewJob();
    const JobRecord for_a_while = gone;
    messages.Of(gone);
  }
  EXPECT_EQ(messages.Of(job).begin(), first.begin());
}

// What is remembered is bounded in bytes, too.
TEST(JobMessages, LongOnesAreNotRemembered) {
  JobMessages messages;
  const JobRecord job = NewJob();
  auto spec = std::make_shared<JobSpec>(*job.spec);
  auto scene = std::make_shared<SceneOutline>(*job.spec->scene);
  scene->name = std::string(JobMessages::kMostBytes, 'x');
  spec->scene = std::move(scene);
  const JobRecord long_one{std::move(spec), job.state};
  const grpc::Slice first = messages.Of(long_one);
  EXPECT_EQ(Told(first).name(), job.spec->id.Name());
  EXPECT_NE(messages.Of(long_one).begin(), first.begin());
}

TEST(JobMessages, KeepsNothingOfAStateThatIsGone) {
  JobMessages messages;
  JobRecord job = NewJob();
  auto field = std::make_shared<Field>();
  const std::weak_ptr<const Field> values = field;
  auto state = std::make_shared<JobState>();
  state->field = std::move(field);
  job.state = std::move(state);
  messages.Of(job);
  job.state = nullptr;
  EXPECT_TRUE(values.expired());
}

}  // namespace
}  // namespace flatlight
