// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/accounts.h"

#include <gtest/gtest.h>

namespace flatlight {
namespace {

TEST(AccountsTest, WhoHasAttainedLeastComesFirst) {
  Accounts accounts;
  accounts.Enter("ada");
  accounts.Enter("bob");
  accounts.Charge("ada", 2);
  accounts.Charge("bob", 1);
  EXPECT_LT(accounts.RankOf("bob"), accounts.RankOf("ada"));
  accounts.Charge("bob", 2);
  EXPECT_LT(accounts.RankOf("ada"), accounts.RankOf("bob"));
}

TEST(AccountsTest, AmongEqualsWhoWasServedLongestAgoComesFirst) {
  Accounts accounts;
  accounts.Enter("ada");
  accounts.Enter("bob");
  accounts.Serve("ada");
  EXPECT_LT(accounts.RankOf("bob"), accounts.RankOf("ada"));
  accounts.Serve("bob");
  EXPECT_LT(accounts.RankOf("ada"), accounts.RankOf("bob"));
}

TEST(AccountsTest, WhoComesStartsLevelWithTheLeastServed) {
  Accounts accounts;
  accounts.Enter("ada");
  accounts.Enter("bob");
  accounts.Charge("ada", 3600);
  accounts.Charge("bob", 1800);
  accounts.Enter("eve");
  EXPECT_EQ(accounts.RankOf("eve").first, accounts.RankOf("bob").first);
  EXPECT_LT(accounts.RankOf("eve"), accounts.RankOf("ada"));
}

TEST(AccountsTest, AnHourAloneIsNoDebtAndAnHourAwayNoCredit) {
  Accounts accounts;
  accounts.Enter("ada");
  accounts.Charge("ada", 3600);
  accounts.Enter("bob");
  EXPECT_EQ(accounts.RankOf("ada").first, accounts.RankOf("bob").first);
  accounts.Leave("bob");
  accounts.Charge("ada", 3600);
  accounts.Enter("bob");
  EXPECT_EQ(accounts.RankOf("ada").first, accounts.RankOf("bob").first);
  // Also if nobody was there in between.
  accounts.Leave("ada");
  accounts.Leave("bob");
  accounts.Enter("eve");
  accounts.Enter("ada");
  EXPECT_EQ(accounts.RankOf("ada").first, accounts.RankOf("eve").first);
}

TEST(AccountsTest, ComingAndGoingClearsNoDebt) {
  Accounts accounts;
  accounts.Enter("ada");
  accounts.Enter("bob");
  accounts.Charge("ada", 10);
  accounts.Leave("ada");
  accounts.Enter("ada");
  EXPECT_EQ(accounts.RankOf("ada").first, 10);
  accounts.Leave("ada");
  accounts.Charge("bob", 20);  // Meanwhile all others have had more.
  accounts.Enter("ada");
  EXPECT_EQ(accounts.RankOf("ada").first, accounts.RankOf("bob").first);
}

TEST(AccountsTest, CountsJobsAndPlaces) {
  Accounts accounts;
  accounts.Enter("ada");
  accounts.Enter("ada");
  accounts.Charge("ada", 1);
  accounts.Leave("ada");
  EXPECT_EQ(accounts.RankOf("ada").first, 1);  // Another job is still there.
  accounts.TakePlace("ada", JobClass::kGraded);
  accounts.TakePlace("ada", JobClass::kGraded);
  accounts.TakePlace("ada", JobClass::kRegrade);
  accounts.TakePlace("bob", JobClass::kInteractive);
  accounts.GivePlace("ada", JobClass::kGraded);
  EXPECT_EQ(accounts.PlacesOf("ada", JobClass::kInteractive), 0u);
  EXPECT_EQ(accounts.PlacesOf("ada", JobClass::kGraded), 1u);
  EXPECT_EQ(accounts.PlacesOf("ada", JobClass::kRegrade), 2u);
  EXPECT_EQ(accounts.PlacesOf("eve", JobClass::kRegrade), 0u);
  EXPECT_EQ(accounts.places(), 3u);
}

}  // namespace
}  // namespace flatlight
