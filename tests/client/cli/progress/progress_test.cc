// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <stdio.h>

#include <cstdlib>

#include "client/cli/progress/progress_display.h"
#include "client/cli/progress/progress_line.h"

namespace flatlight {
namespace {

using std::chrono::milliseconds;

v1::Job Running(double fraction) {
  v1::Job job;
  job.set_scene("penumbra");
  job.set_state(v1::Job::RUNNING);
  job.mutable_progress()->set_fraction(fraction);
  job.mutable_progress()->set_rays(24.8e6);
  job.mutable_progress()->set_elapsed_seconds(2);
  job.mutable_progress()->set_remaining_seconds(3);
  job.mutable_progress()->set_relative_error(0.013);
  return job;
}

TEST(ProgressLine, SaysAllThatIsKnown) {
  EXPECT_EQ(ProgressLine(Running(0.527), 0), "penumbra  52 %  error 1.3 %  12.4 M rays/s  3.0 s left");
  EXPECT_EQ(ProgressLine(Running(0.5), 100),
            "penumbra [############------------]  50 %  error 1.3 %  12.4 M rays/s  3.0 s left");
}

TEST(ProgressLine, CountsRecords) {
  v1::Job job = Running(0.5);
  job.mutable_progress()->clear_rays();
  job.mutable_progress()->set_records(132);
  EXPECT_EQ(ProgressLine(job, 0), "penumbra  50 %  error 1.3 %  132 records  3.0 s left");
}

TEST(ProgressLine, LeavesOutWhatIsUnknown) {
  v1::Job job = Running(0.1);
  job.clear_progress();
  EXPECT_EQ(ProgressLine(job, 0), "penumbra   0 %");
  job.set_state(v1::Job::QUEUED);
  EXPECT_EQ(ProgressLine(job, 0), "penumbra  waiting for its turn");
}

TEST(ProgressLine, FitsAnyWidth) {
  for (std::size_t width = 1; width < 120; ++width) EXPECT_LE(ProgressLine(Running(0.5), width).size(), width) << width;
  EXPECT_EQ(ProgressLine(Running(0.5), 20), "penumbra  50 %  erro");
}

TEST(ProgressLine, OneHundredPercentIsTheEnd) {
  v1::Job job = Running(1);
  EXPECT_EQ(ProgressLine(job, 0).substr(0, 14), "penumbra  99 %");
  job.set_state(v1::Job::SUCCEEDED);
  EXPECT_EQ(ProgressLine(job, 0), "penumbra 100 %  error 1.3 %  12.4 M rays/s");
  job.mutable_progress()->set_fraction(7);
  EXPECT_EQ(ProgressLine(job, 0).substr(0, 14), "penumbra 100 %");
}

// What a display wrote, in a file of memory.
class ProgressDisplayTest : public ::testing::Test {
 protected:
  ~ProgressDisplayTest() override {
    fclose(file_);
    free(buffer_);
  }
  std::string Written() {
    fflush(file_);
    return {buffer_, size_};
  }

  char* buffer_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* file_ = open_memstream(&buffer_, &size_);
  ProgressDisplay::Time start_{};
};

TEST_F(ProgressDisplayTest, PlainLinesComeOnceASecond) {
  ProgressDisplay display(file_);
  for (int i = 0; i < 25; ++i) display.Show(Running(i / 100.0), start_ + milliseconds(100 * i), std::nullopt);
  v1::Job ended = Running(1);
  ended.set_state(v1::Job::SUCCEEDED);
  display.Show(ended, start_ + milliseconds(2450), std::nullopt);
  EXPECT_EQ(Written(),
            "penumbra   0 %  error 1.3 %  12.4 M rays/s  3.0 s left\n"
            "penumbra  10 %  error 1.3 %  12.4 M rays/s  3.0 s left\n"
            "penumbra  20 %  error 1.3 %  12.4 M rays/s  3.0 s left\n"
            "penumbra 100 %  error 1.3 %  12.4 M rays/s\n");
}

TEST_F(ProgressDisplayTest, TheTerminalLineIsRedrawnAndCleared) {
  {
    ProgressDisplay display(file_);
    display.Show(Running(0.25), start_, 15);
    display.Show(Running(0.25), start_, 15);
    display.Show(Running(0.5), start_, 15);
  }
  EXPECT_EQ(Written(), "\r\x1b[Kpenumbra  25 %\r\x1b[Kpenumbra  50 %\r\x1b[K");
}

}  // namespace
}  // namespace flatlight
