// SPDX-License-Identifier: Apache-2.0
#include "server/webhook/webhook_sender.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
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
  // All so far, once there are so many.
  std::vector<Outcome> AwaitAttempts(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return attempts_.size() >= count; });
    return attempts_;
  }
  // Once so many attempts are written.
  WebhookState AwaitState(const JobId& job, unsigned attempts) {
    while (true) {
      WebhookState state = **outbox_.Of(job);
      if (state.attempts >= attempts) return state;
      std::this_thread::sleep_for(milliseconds(1));
    }
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
