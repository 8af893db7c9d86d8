// SPDX-License-Identifier: Apache-2.0
#include "server/store/webhook_outbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "server/store/error.h"
#include "server/store/job_archive.h"
#include "server/store/schema.h"
#include "server/store/storage.h"
#include "tests/support/status/status_matchers.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::IsOk;

const WallTime kNow{std::chrono::hours(24 * 365 * 50)};

class WebhookOutboxTest : public ::testing::Test {
 protected:
  JobId AddDue(const std::string& owner) {
    const JobId job = JobId::Random();
    EXPECT_THAT(outbox_.Insert(job, owner, "https://example.org/"), IsOk());
    EXPECT_THAT(outbox_.MakeDue(job, "body of " + owner), IsOk());
    return job;
  }
  std::vector<std::string> OwnersDue(WallTime now, std::size_t per_owner = 100, std::size_t most = 100) {
    std::vector<std::string> owners;
    const auto due = *outbox_.Due(now, per_owner, most);
    for (const DueWebhook& webhook : due) owners.push_back(webhook.owner);
    return owners;
  }

  WebhookOutbox outbox_{*NewMemoryDatabase()};
};

TEST_F(WebhookOutboxTest, NothingIsDueBeforeTheEndOfItsJob) {
  const JobId job = JobId::Random();
  ASSERT_THAT(outbox_.Insert(job, "ada", "https://example.org/"), IsOk());
  EXPECT_THAT(OwnersDue(kNow), IsEmpty());
  EXPECT_FALSE((*outbox_.Of(job))->next_attempt);
  EXPECT_FALSE(outbox_.NextDue()->has_value());
  EXPECT_EQ(*outbox_.OpenOf("ada"), 1u);
  ASSERT_THAT(outbox_.MakeDue(job, "body"), IsOk());
  const auto due = *outbox_.Due(WallTime(), 1, 1);  // Whatever the clock says.
  ASSERT_EQ(due.size(), 1u);
  EXPECT_EQ(due[0].job, job);
  EXPECT_EQ(due[0].body, "body");
  EXPECT_EQ(due[0].url, "https://example.org/");
  EXPECT_TRUE(outbox_.NextDue()->has_value());
  EXPECT_FALSE(outbox_.Of(JobId::Random())->has_value());
}

TEST_F(WebhookOutboxTest, WhatFailedComesAgainLaterAndAfterWhatIsNew) {
  const JobId job = AddDue("ada");
  const std::int64_t number = outbox_.Due(kNow, 1, 1)->front().number;
  ASSERT_THAT(outbox_.TryAgain(number, "answered with status 500", kNow + std::chrono::seconds(5)), IsOk());
  EXPECT_THAT(OwnersDue(kNow), IsEmpty());
  EXPECT_EQ(*outbox_.NextDue(), kNow + std::chrono::seconds(5));
  AddDue("bob");
  EXPECT_THAT(OwnersDue(kNow + std::chrono::seconds(5)), ElementsAre("bob", "ada"));
  const WebhookState state = **outbox_.Of(job);
  EXPECT_EQ(state.attempts, 1u);
  EXPECT_EQ(state.error, "answered with status 500");
  EXPECT_EQ(state.next_attempt, kNow + std::chrono::seconds(5));
  EXPECT_FALSE(state.end_time);
}

TEST_F(WebhookOutboxTest, WhatIsDoneIsRememberedAndNotSentAgain) {
  const JobId taken = AddDue("ada");
  const JobId lost = AddDue("bob");
  const auto due = *outbox_.Due(kNow, 1, 9);
  ASSERT_THAT(outbox_.Delivered(due[0].number, kNow), IsOk());
  ASSERT_THAT(outbox_.GiveUp(due[1].number, "why", kNow), IsOk());
  EXPECT_THAT(OwnersDue(kNow), IsEmpty());
  EXPECT_TRUE((*outbox_.Of(taken))->delivered);
  EXPECT_EQ((*outbox_.Of(taken))->end_time, kNow);
  EXPECT_FALSE((*outbox_.Of(lost))->delivered);
  EXPECT_EQ((*outbox_.Of(lost))->error, "why");
  EXPECT_EQ(*outbox_.OpenOf(std::nullopt), 0u);
  ASSERT_THAT(outbox_.MakeDue(taken, "again"), IsOk());  // A job ends once.
  EXPECT_THAT(OwnersDue(kNow), IsEmpty());
}

TEST_F(WebhookOutboxTest, NoOwnerHoldsUpAnother) {
  for (int i = 0; i < 50; ++i) AddDue("ada");
  AddDue("bob");
  EXPECT_THAT(OwnersDue(kNow, 2), ElementsAre("ada", "ada", "bob"));
  EXPECT_THAT(OwnersDue(kNow, 2, 1), ElementsAre("ada"));
  EXPECT_EQ(*outbox_.OpenOf("ada"), 50u);
  EXPECT_EQ(*outbox_.OpenOf(std::nullopt), 51u);
}

TEST_F(WebhookOutboxTest, ADeletedJobIsToldOfIfItHadEnded) {
  const JobId waiting = JobId::Random();
  ASSERT_THAT(outbox_.Insert(waiting, "ada", "https://example.org/"), IsOk());
  const JobId ended = AddDue("ada");
  ASSERT_THAT(outbox_.Detach(waiting), IsOk());
  ASSERT_THAT(outbox_.Detach(ended), IsOk());
  EXPECT_FALSE(outbox_.Of(waiting)->has_value());
  const auto due = *outbox_.Due(kNow, 9, 9);
  ASSERT_EQ(due.size(), 1u);
  ASSERT_THAT(outbox_.Delivered(due[0].number, kNow), IsOk());
  EXPECT_FALSE(outbox_.Of(ended)->has_value());
}

TEST_F(WebhookOutboxTest, TheKeyStaysTheSame) {
  const std::string key = *outbox_.Key();
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(*outbox_.Key(), key);
  EXPECT_NE(*WebhookOutbox(*NewMemoryDatabase()).Key(), key);
}

TEST(JobArchiveWebhooks, AnEndAndItsWebhookAreOneChange) {
  const testing::TemporaryFolder folder;
  const auto storage = *Storage::Open(folder.path());
  JobArchive archive(*storage, "build");
  int told = 0;
  archive.WhenWebhookIsDue([&] { ++told; });
  WebhookOutbox outbox(*Database::OpenExisting(Storage::DatabasePath(folder.path())));
  const JobId job = JobId::Random();
  Submission submission{"request", "", nullptr};
  submission.webhook = "https://example.org/";
  ASSERT_THAT(archive.Insert(job, "ada", "message", submission, std::nullopt, kNow), IsOk());
  ASSERT_THAT(archive.End(JobId::Random(), {.message = "ended", .time = kNow, .event = "event"}),
              testing::StatusIs(absl::StatusCode::kNotFound, ::testing::_));
  EXPECT_THAT(*outbox.Due(kNow, 9, 9), IsEmpty());
  // Whichever of the two cannot be written, the other is not written either.
  const auto other = *Database::OpenExisting(Storage::DatabasePath(folder.path()));
  for (const std::string table : {"webhooks", "jobs"}) {
    ASSERT_THAT(
        other->Execute("CREATE TRIGGER refuse BEFORE UPDATE ON " + table + " BEGIN SELECT raise(ABORT, 'full'); END"),
        IsOk());
    EXPECT_FALSE(archive.End(job, {.message = "ended", .time = kNow, .event = "event"}).ok()) << table;
    EXPECT_EQ(archive.Unfinished()->size(), 1u) << table;
    EXPECT_THAT(*outbox.Due(kNow, 9, 9), IsEmpty()) << table;
    EXPECT_EQ(told, 0);
    ASSERT_THAT(other->Execute("DROP TRIGGER refuse"), IsOk());
  }
  ASSERT_THAT(archive.End(job, {.message = "ended", .time = kNow, .event = "event"}), IsOk());
  EXPECT_EQ(told, 1);
  ASSERT_EQ(outbox.Due(kNow, 9, 9)->size(), 1u);
  EXPECT_EQ(outbox.Due(kNow, 9, 9)->front().body, "event");
  ASSERT_THAT(archive.Delete(job), IsOk());
  EXPECT_EQ(outbox.Due(kNow, 9, 9)->size(), 1u);
  ASSERT_THAT(outbox.Delivered(outbox.Due(kNow, 9, 9)->front().number, kNow), IsOk());
  EXPECT_FALSE(outbox.Of(job)->has_value());
}

std::vector<std::int64_t> GenerationsOf(const std::vector<SecretTerm>& terms) {
  std::vector<std::int64_t> generations;
  for (const SecretTerm& term : terms) generations.push_back(term.generation);
  return generations;
}

TEST_F(WebhookOutboxTest, AnEarlierSecretIsUsedUntilItsTimeIsOver) {
  using std::chrono::hours;
  EXPECT_THAT(GenerationsOf(*outbox_.SecretsOf("ada", kNow)), ElementsAre(0));
  EXPECT_THAT(GenerationsOf(*outbox_.RotateSecretOf("ada", kNow, hours(24))), ElementsAre(1, 0));
  EXPECT_THAT(GenerationsOf(*outbox_.RotateSecretOf("ada", kNow + hours(1), hours(48))), ElementsAre(2, 1, 0));
  const auto terms = *outbox_.SecretsOf("ada", kNow + hours(2));
  ASSERT_EQ(terms.size(), 3u);
  EXPECT_FALSE(terms[0].expire_time);
  EXPECT_EQ(terms[1].expire_time, kNow + hours(49));
  EXPECT_EQ(terms[2].expire_time, kNow + hours(24)) << "none gets a longer term than it was given";
  EXPECT_THAT(GenerationsOf(*outbox_.SecretsOf("ada", kNow + hours(24))), ElementsAre(2, 1));
  EXPECT_THAT(GenerationsOf(*outbox_.SecretsOf("ada", kNow + hours(49))), ElementsAre(2));
  EXPECT_THAT(GenerationsOf(*outbox_.SecretsOf("bob", kNow)), ElementsAre(0));
  // One that others know: no earlier one is used from then on, nor ever again.
  EXPECT_THAT(GenerationsOf(*outbox_.RotateSecretOf("ada", kNow + hours(3), hours(0))), ElementsAre(3));
  EXPECT_THAT(GenerationsOf(*outbox_.SecretsOf("ada", kNow)), ElementsAre(3));
}

TEST_F(WebhookOutboxTest, EarlierSecretsAreFew) {
  using std::chrono::hours;
  for (std::size_t i = 0; i < kMaxEarlierSecrets; ++i) {
    ASSERT_THAT(outbox_.RotateSecretOf("ada", kNow, hours(24)), IsOk());
  }
  const auto before = GenerationsOf(*outbox_.SecretsOf("ada", kNow));
  const auto refused = outbox_.RotateSecretOf("ada", kNow + hours(1), hours(24));
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(RetryAfterOf(refused.status()), std::chrono::milliseconds(hours(23)));
  EXPECT_EQ(GenerationsOf(*outbox_.SecretsOf("ada", kNow)), before);
  EXPECT_THAT(outbox_.RotateSecretOf("ada", kNow + hours(24), hours(24)), IsOk());
  EXPECT_THAT(GenerationsOf(*outbox_.RotateSecretOf("ada", kNow, hours(0))), ElementsAre(7));
}

}  // namespace
}  // namespace flatlight
