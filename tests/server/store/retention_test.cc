// SPDX-License-Identifier: Apache-2.0
#include "server/store/retention.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using namespace std::chrono_literals;
using testing::IsOk;

TEST(Retention, GradesAreKeptUnlessItIsSaidOtherwise) {
  const Retention retention;
  EXPECT_EQ(retention.Of(JobClass::kInteractive), std::chrono::hours(24 * 30));
  EXPECT_EQ(retention.Of(JobClass::kGraded), std::nullopt);
  EXPECT_EQ(retention.Of(JobClass::kRegrade), std::nullopt);
}

TEST(Retention, IsSetByClass) {
  Retention retention;
  for (const char* text : {"interactive=90m", "graded=365d", "regrade=45s"}) EXPECT_THAT(retention.Set(text), IsOk());
  EXPECT_EQ(retention.Of(JobClass::kInteractive), 5400s);
  EXPECT_EQ(retention.Of(JobClass::kGraded), 24h * 365);
  EXPECT_EQ(retention.Of(JobClass::kRegrade), 45s);
  const Retention::WallTime end{1000h};
  EXPECT_EQ(retention.ExpireTime(JobClass::kRegrade, end), end + 45s);
  EXPECT_THAT(retention.Set("interactive=none"), IsOk());
  EXPECT_EQ(retention.ExpireTime(JobClass::kInteractive, end), std::nullopt);
}

TEST(Retention, MistakesChangeNothing) {
  Retention retention;
  for (const char* text :
       {"", "interactive", "interactive=", "interactive=30", "interactive=d", "interactive=0d", "interactive=-1d",
        "interactive=+1d", "interactive=1.5d", "interactive=36501d", "interactive=99999999999999999999d",
        "interactive=1w", "interactive= 1d", "all=1d", "=1d", "Interactive=1d"}) {
    EXPECT_EQ(retention.Set(text).code(), absl::StatusCode::kInvalidArgument) << text;
    EXPECT_EQ(retention.Of(JobClass::kInteractive), std::chrono::hours(24 * 30)) << text;
  }
}

}  // namespace
}  // namespace flatlight
