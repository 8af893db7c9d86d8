// SPDX-License-Identifier: Apache-2.0
#include "server/quota/cpu_ledger.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "tests/support/status/status_matchers.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

using testing::IsOk;

constexpr std::chrono::hours kDay{24};
constexpr CpuLedger::WallTime kNoon{std::chrono::hours(24 * 20'000 + 12)};

class CpuLedgerTest : public ::testing::Test {
 protected:
  CpuLedgerTest() { Open(); }
  void Open() {
    storage_ = *Storage::Open(folder_.path());
    // It writes only when it is told to.
    ledger_ = std::make_unique<CpuLedger>(
        storage_.get(), CpuLedger::Options{.interval = std::chrono::hours(1), .now = [this] { return now_; }});
  }
  // Without a last writing, as if the process were killed: on a copy of what is on the disk.
  double UsedAfterKill(const std::string& user) {
    CpuLedger next(storage_.get(), {.interval = std::chrono::hours(1), .now = [this] { return now_; }});
    return next.UsedToday(user);
  }
  testing::TemporaryFolder folder_;
  CpuLedger::WallTime now_ = kNoon;
  std::unique_ptr<Storage> storage_;
  std::unique_ptr<CpuLedger> ledger_;
};

TEST_F(CpuLedgerTest, SumsUpByUserAndDay) {
  EXPECT_EQ(ledger_->Charge("ada", 1.5), 1.5);
  EXPECT_EQ(ledger_->Charge("ada", 2), 3.5);
  EXPECT_EQ(ledger_->Charge("bob", 4), 4);
  EXPECT_EQ(ledger_->UsedToday("ada"), 3.5);
  EXPECT_EQ(ledger_->UsedToday("bob"), 4);
  EXPECT_EQ(ledger_->UsedToday("eve"), 0);
  EXPECT_EQ(ledger_->EndOfToday(), kNoon + std::chrono::hours(12));
  EXPECT_EQ(ledger_->UntilTomorrow(), std::chrono::hours(12));
  now_ = kNoon + std::chrono::hours(12) - std::chrono::nanoseconds(1);
  EXPECT_EQ(ledger_->UsedToday("ada"), 3.5);
  now_ = kNoon + std::chrono::hours(12);
  EXPECT_EQ(ledger_->UsedToday("ada"), 0);
  EXPECT_EQ(ledger_->EndOfToday(), kNoon + std::chrono::hours(36));
  ledger_->Charge("ada", 1);
  now_ = kNoon;
  EXPECT_EQ(ledger_->UsedToday("ada"), 3.5) << "a clock that is set back finds the day as it was";
}

TEST_F(CpuLedgerTest, WhatIsWrittenOutlivesTheProcess) {
  ledger_->Charge("ada", 3);
  EXPECT_EQ(UsedAfterKill("ada"), 0);
  ASSERT_THAT(ledger_->Write(), IsOk());
  EXPECT_EQ(UsedAfterKill("ada"), 3);
  ledger_->Charge("ada", 2);
  ASSERT_THAT(ledger_->Write(), IsOk());
  ASSERT_THAT(ledger_->Write(), IsOk()) << "nothing is written twice";
  EXPECT_EQ(UsedAfterKill("ada"), 5);
  ledger_->Charge("ada", 1);
  ledger_.reset();
  storage_.reset();
  Open();
  EXPECT_EQ(ledger_->UsedToday("ada"), 6) << "an orderly end loses nothing";
}

TEST_F(CpuLedgerTest, ItWritesByItself) {
  CpuLedger busy(storage_.get(), {.interval = std::chrono::milliseconds(1), .now = [this] { return now_; }});
  busy.Charge("ada", 3);
  while (UsedAfterKill("ada") != 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(CpuLedgerTest, DaysAreKeptForMoreThanATerm) {
  ledger_->Charge("ada", 3);
  ASSERT_THAT(ledger_->Write(), IsOk());
  const auto days = [&] {
    std::int64_t count = 0;
    EXPECT_THAT(storage_->Read([&](Database& database) {
      Statement rows = database.Prepare("SELECT count(*) FROM cpu_days");
      const auto row = rows.Step();
      count = rows.Integer(0);
      return row.status();
    }),
                IsOk());
    return count;
  };
  now_ = kNoon + 200 * kDay;
  ledger_->Charge("ada", 1);
  ASSERT_THAT(ledger_->Write(), IsOk());
  EXPECT_EQ(days(), 2);
  now_ = kNoon + 401 * kDay;
  ledger_->Charge("ada", 1);
  ASSERT_THAT(ledger_->Write(), IsOk());
  EXPECT_EQ(days(), 2);
}

TEST_F(CpuLedgerTest, WithoutAFolderItCountsToo) {
  CpuLedger ledger(nullptr, {.now = [this] { return now_; }});
  ledger.Charge("ada", 3);
  ASSERT_THAT(ledger.Write(), IsOk());
  EXPECT_EQ(ledger.UsedToday("ada"), 3);
  now_ += kDay;
  EXPECT_EQ(ledger.UsedToday("ada"), 0);
  ledger.Charge("ada", 1);
  now_ -= kDay;
  EXPECT_EQ(ledger.UsedToday("ada"), 3);
}

}  // namespace
}  // namespace flatlight
