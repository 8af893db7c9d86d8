// SPDX-License-Identifier: Apache-2.0
#include "server/store/user_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "server/store/schema.h"
#include "server/store/sha256.h"
#include "tests/support/status/status_matchers.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

using absl::StatusCode;
using ::testing::_;
using ::testing::ElementsAre;
using testing::IsOk;
using testing::StatusIs;

// Another process, as far as SQLite knows: a connection of its own.
class UserDirectoryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string path = folder_.path() + "/users.db";
    other_ = *Database::Open(path);
    ASSERT_THAT(Migrate(*other_), IsOk());
    directory_ = std::make_unique<UserDirectory>(*Database::OpenExisting(path));
  }
  std::string Add(const std::string& name, Role role = Role::kStudent) {
    const auto tokens = UserStore(*other_).Add({{name, role, {"lab"}}});
    EXPECT_THAT(tokens, IsOk());
    return Sha256Of(tokens->front());
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<Database> other_;
  std::unique_ptr<UserDirectory> directory_;
};

TEST_F(UserDirectoryTest, ChangesByOthersAreSeenAtOnce) {
  EXPECT_FALSE(*directory_->HasUsers());
  EXPECT_FALSE(*directory_->HasUsers());
  const std::string ada = Add("ada");
  EXPECT_TRUE(*directory_->HasUsers());
  for (int i = 0; i < 2; ++i) {
    const auto found = directory_->FindByTokenHash(ada);
    ASSERT_THAT(found, IsOk());
    EXPECT_EQ(found->name, "ada");
    EXPECT_THAT(found->groups, ElementsAre("lab"));
  }
  EXPECT_THAT(directory_->FindByTokenHash(Sha256Of("a guess")), StatusIs(StatusCode::kUnauthenticated, _));
  ASSERT_THAT(UserStore(*other_).Revoke("ada"), IsOk());
  EXPECT_THAT(directory_->FindByTokenHash(ada), StatusIs(StatusCode::kUnauthenticated, _));
  const std::string again = Add("ada", Role::kGrader);
  EXPECT_THAT(directory_->FindByTokenHash(ada), StatusIs(StatusCode::kUnauthenticated, _));
  EXPECT_EQ(directory_->FindByTokenHash(again)->role, Role::kGrader);
  ASSERT_THAT(UserStore(*other_).Revoke("ada"), IsOk());
  EXPECT_TRUE(*directory_->HasUsers()) << "revoking the last user opens nothing";
}

TEST_F(UserDirectoryTest, TheVersionIsThatOfUsersAlone) {
  std::int64_t version = directory_->Version();
  const auto expect_change = [&](bool changed, const std::string& sql) {
    ASSERT_THAT(other_->Execute(sql), IsOk());
    const std::int64_t now = directory_->Version();
    EXPECT_EQ(now != version, changed) << sql;
    version = now;
  };
  expect_change(false, "INSERT INTO cpu_days VALUES('ada', 1, 2)");
  expect_change(true, "INSERT INTO users VALUES('ada', 'student', 'hash')");
  expect_change(true, "INSERT INTO memberships VALUES('ada', 'lab')");
  expect_change(false, "UPDATE cpu_days SET seconds = 3");
  expect_change(true, "UPDATE users SET role = 'grader'");
  expect_change(true, "UPDATE memberships SET group_name = 'lab-2'");
  expect_change(true, "DELETE FROM memberships");
  expect_change(true, "DELETE FROM users");
}

TEST_F(UserDirectoryTest, TheLogsHeaderChangesWithEveryCommitOfOthers) {
  const auto mine = *Database::OpenExisting(other_->path());
  ASSERT_TRUE(*mine->Prepare("SELECT 1 FROM users_version").Step());
  const auto before = mine->ReadLogHeader();
  ASSERT_TRUE(before.has_value());
  EXPECT_EQ(mine->ReadLogHeader(), before);
  Transaction transaction(*other_);
  ASSERT_THAT(transaction.Begin(), IsOk());
  ASSERT_THAT(other_->Execute("INSERT INTO cpu_days VALUES('ada', 1, 2)"), IsOk());
  EXPECT_EQ(mine->ReadLogHeader(), before) << "it is not committed";
  ASSERT_THAT(transaction.Commit(), IsOk());
  EXPECT_NE(mine->ReadLogHeader(), before);
}

}  // namespace
}  // namespace flatlight
