// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/startup_watch.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace flatlight {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Verdict = StartupWatch::Verdict;
constexpr StartupWatch::Time kStart{};

TEST(StartupWatch, WaitsForWhatWorksOrWaitsForAProcessor) {
  StartupWatch watch(kStart);
  for (int second = 0; second < 100; ++second) {
    EXPECT_EQ(watch.Look(kStart + seconds(second), {milliseconds(second / 9), false}), Verdict::kGoesOn) << second;
  }
  for (int second = 100; second < 200; ++second) {
    EXPECT_EQ(watch.Look(kStart + seconds(second), {seconds(9), true}), Verdict::kGoesOn) << second;
  }
}

TEST(StartupWatch, GivesUpWhatDoesNothing) {
  StartupWatch watch(kStart);
  EXPECT_EQ(watch.Look(kStart + seconds(50), {milliseconds(20), false}), Verdict::kGoesOn);
  EXPECT_EQ(watch.Look(kStart + seconds(59), {milliseconds(20), false}), Verdict::kGoesOn);
  EXPECT_EQ(watch.Look(kStart + seconds(60), {milliseconds(20), false}), Verdict::kIdle);
}

TEST(StartupWatch, WaitsNotForEver) {
  StartupWatch watch(kStart);
  EXPECT_EQ(watch.Look(kStart + StartupWatch::kPatience, {seconds(1), true}), Verdict::kTooLong);
}

TEST(StartupWatch, TellsOnce) {
  StartupWatch watch(kStart);
  EXPECT_FALSE(watch.WorthTelling(kStart + milliseconds(100)));
  EXPECT_TRUE(watch.WorthTelling(kStart + seconds(3)));
  EXPECT_FALSE(watch.WorthTelling(kStart + seconds(9)));
}

// A child that sleeps, and one that works.
TEST(ReadActivity, TellsAWorkerFromASleeper) {
  const auto fork_one = [](bool works) {
    const pid_t child = fork();
    if (child == 0) {
      for (volatile int turns = 0; works;) turns = turns ^ 1;
      pause();
      _exit(0);
    }
    return child;
  };
  const pid_t worker = fork_one(true), sleeper = fork_one(false);
  while (ReadActivity(sleeper).wants_to_run || ReadActivity(worker).cpu < milliseconds(20)) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_TRUE(ReadActivity(worker).wants_to_run);
  const ProcessActivity before = ReadActivity(sleeper);
  EXPECT_FALSE(before.wants_to_run);
  EXPECT_EQ(ReadActivity(sleeper).cpu, before.cpu);
  for (const pid_t child : {worker, sleeper}) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
}

}  // namespace
}  // namespace flatlight
