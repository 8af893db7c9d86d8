// SPDX-License-Identifier: Apache-2.0
#include "server/webhook/webhook_sender.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/store/schema.h"
#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::IsOk;
using Outcome = WebhookAttempt::Outcome;

const WallTime kStart{std::chrono::hours(24 * 365 * 50)};
const char kNobody[] = "127.0.0.1:1";  // Where nobody listens.
constexpr seconds kPatience{60};       // An attempt takes milliseconds: only one that is never made takes so long.

// A sender whose clock is the test's.
class WebhookSenderTest : public ::testing::Test {
 protected:
  WebhookSenderTest() { EXPECT_THAT(rules_.Allow(kNobody), IsOk()); }

  WallTime now() {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  void SetTime(WallTime time, WebhookSender& sender) {
    {
      const std::lock_guard lock(mutex_);
      now_ = time;
    }
    sender.Wake();
  }
  WebhookSender::Options OptionsOf(std::vector<milliseconds> retries) {
    WebhookSender::Options options;
    options.retries = std::move(retries);
    options.now = [this] { return now(); };
    return options;
  }
  void Note(const WebhookAttempt& attempt) {
    const std::lock_guard lock(mutex_);
    attempts_.push_back(attempt.outcome);
    changed_.notify_all();
  }
  // All so far, once there are so many; ends the test if they do not come.
  std::vector<Outcome> AwaitAttempts(std::size_t count) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, kPatience, [&] { return attempts_.size() >= count; })) {
      ThrowMissing(attempts_.size(), count, "made");
    }
    return attempts_;
  }
  // Once so many attempts are written; ends the test if they are not.
  WebhookState AwaitState(const JobId& job, unsigned attempts) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (true) {
      WebhookState state = **outbox_.Of(job);
      if (state.attempts >= attempts) return state;
      if (std::chrono::steady_clock::now() > end) ThrowMissing(state.attempts, attempts, "written");
      std::this_thread::sleep_for(milliseconds(1));
    }
  }

  // GoogleTest reports it as a failure of the test, whose sender is closed on the way.
  [[noreturn]] static void ThrowMissing(std::size_t attempts, std::size_t wanted, const std::string& what) {
    throw std::runtime_error(std::to_string(attempts) + " of " + std::to_string(wanted) + " attempts were " + what +
                             " within " + std::to_string(kPatience.count()) + " s");
  }

  WebhookRules rules_;
  WebhookOutbox outbox_{*NewMemoryDatabase()};
  std::mutex mutex_;
  std::condition_variable changed_;
  WallTime now_ = kStart;
  std::vector<Outcome> attempts_;
};

TEST_F(WebhookSenderTest, WhatFailsIsSentAgainAfterEachOfTheDelaysAndThenGivenUp) {
  const std::vector<milliseconds> retries = {seconds(5), seconds(30), std::chrono::hours(10)};
  const JobId job = JobId::Random();
  ASSERT_THAT(outbox_.Insert(job, "ada", std::string("http://") + kNobody + "/"), IsOk());
  ASSERT_THAT(outbox_.MakeDue(job, "body"), IsOk());
  WebhookSender sender(OptionsOf(retries), rules_, outbox_, "key", "agent",
                       [this](const WebhookAttempt& attempt) { Note(attempt); });
  for (unsigned failures = 1; failures <= retries.size(); ++failures) {
    const milliseconds delay = retries[failures - 1];
    const WebhookState state = AwaitState(job, failures);
    EXPECT_EQ(state.attempts, failures);
    EXPECT_FALSE(state.end_time);
    ASSERT_TRUE(state.next_attempt);
    EXPECT_GE(*state.next_attempt, now() + delay);
    EXPECT_LE(*state.next_attempt, now() + delay + delay / 5);
    EXPECT_EQ(AwaitAttempts(failures), std::vector<Outcome>(failures, Outcome::kFailed));
    SetTime(*state.next_attempt, sender);
  }
  const WebhookState last = AwaitState(job, 4);
  EXPECT_FALSE(last.delivered);
  EXPECT_EQ(last.end_time, now());
  EXPECT_EQ(AwaitAttempts(4).back(), Outcome::kGivenUp);
}

TEST_F(WebhookSenderTest, TheDelaysAreThoseOfTheManual) {
  using std::chrono::hours, std::chrono::minutes;
  const std::vector<milliseconds> retries = {seconds(5), seconds(30), minutes(5), minutes(30),
                                             hours(2),   hours(5),    hours(10)};
  EXPECT_EQ(WebhookSender::Options().retries, retries);
}

}  // namespace
}  // namespace flatlight
