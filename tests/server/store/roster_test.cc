// SPDX-License-Identifier: Apache-2.0
#include "server/store/roster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/support/status/status_matchers.h"

namespace flatlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::IsOk;
using testing::StatusIs;

TEST(Roster, ReadsWhatSpreadsheetsWrite) {
  const auto roster =
      ParseRoster("c.csv", "\xEF\xBB\xBFrole,name,groups\r\n\r\ngrader,\"ada\",a;b\r\n,bob,\r\n,\"e\"\"v\",");
  ASSERT_THAT(roster, IsOk());
  ASSERT_EQ(roster->users.size(), 3u);
  EXPECT_EQ(roster->users[0].name, "ada");
  EXPECT_EQ(roster->users[0].role, Role::kGrader);
  EXPECT_THAT(roster->users[0].groups, ElementsAre("a", "b"));
  EXPECT_EQ(roster->users[1].role, Role::kStudent);
  EXPECT_THAT(roster->users[1].groups, IsEmpty());
  EXPECT_EQ(roster->users[2].name, "e\"v");
  EXPECT_THAT(roster->places, ElementsAre("c.csv:3", "c.csv:4", "c.csv:5"));
}

TEST(Roster, SaysWhereTheMistakeIs) {
  const std::pair<const char*, const char*> kMistakes[] = {
      {"", "c.csv: names no users"},
      {"name\n", "c.csv: names no users"},
      {"role\nada", "c.csv:1: there must be a column \"name\""},
      {"name,mail\n", "c.csv:1: the column \"mail\" must be"},
      {"name,name\n", "c.csv:1: the column \"name\" is there twice"},
      {"name,role\nada,root", "c.csv:2: the role \"root\" must be"},
      {"name\nada\nbob,x", "c.csv:3: has 2 fields; the first line has 1"},
      {"name\n\"ada", "c.csv:2: a quoted field has no closing"},
      {"name\n\"ada\"x", "c.csv:2: a comma must follow"},
      {"name\na\"da", "c.csv:2: a field with \" in it"},
  };
  for (const auto& [text, message] : kMistakes) {
    EXPECT_THAT(ParseRoster("c.csv", text), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(message)));
  }
}

}  // namespace
}  // namespace flatlight
