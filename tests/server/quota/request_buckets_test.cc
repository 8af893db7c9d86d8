// SPDX-License-Identifier: Apache-2.0
#include "server/quota/request_buckets.h"

#include <gtest/gtest.h>

#include "tests/support/rendering/fake_clock.h"

namespace flatlight {
namespace {

using std::chrono::milliseconds;

class RequestBucketsTest : public ::testing::Test {
 protected:
  int TakeAll(const std::string& user, double a_second) {
    int taken = 0;
    while (!buckets_.Take(user, a_second)) ++taken;
    return taken;
  }
  testing::FakeClock clock_;
  RequestBuckets buckets_{clock_};
};

TEST_F(RequestBucketsTest, SoManyAtOnceAndThenAsManyASecond) {
  EXPECT_EQ(TakeAll("ada", 2), 20);
  EXPECT_EQ(buckets_.Take("ada", 2), milliseconds(500));
  EXPECT_FALSE(buckets_.Take("bob", 2)) << "each has a bucket";
  clock_.Advance(milliseconds(300));
  EXPECT_EQ(buckets_.Take("ada", 2), milliseconds(200)) << "being refused costs nothing";
  clock_.Advance(milliseconds(200));
  EXPECT_EQ(TakeAll("ada", 2), 1);
  EXPECT_DOUBLE_EQ(buckets_.Taken("ada", 2), 20);
  EXPECT_DOUBLE_EQ(buckets_.Taken("bob", 2), 0) << "it has been filled again";
  clock_.Advance(std::chrono::hours(1));
  EXPECT_EQ(TakeAll("ada", 2), 20) << "no rest makes it hold more";
}

TEST_F(RequestBucketsTest, SeldomIsMoreThanNever) {
  EXPECT_EQ(TakeAll("ada", 0.01), 1);
  clock_.Advance(std::chrono::seconds(99));
  EXPECT_TRUE(buckets_.Take("ada", 0.01));
  clock_.Advance(std::chrono::seconds(2));
  EXPECT_EQ(TakeAll("ada", 0.01), 1);
}

}  // namespace
}  // namespace flatlight
