// SPDX-License-Identifier: Apache-2.0
#include "server/store/user_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "server/store/schema.h"
#include "server/store/storage.h"
#include "tests/support/status/status_matchers.h"
#include "tests/support/status/temporary_folder.h"

namespace flatlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::IsOk;
using testing::StatusIs;

class UserStoreTest : public ::testing::Test {
 protected:
  std::unique_ptr<Database> Open() { return *Database::Open(Storage::DatabasePath(folder_.path())); }
  void SetUp() override {
    database_ = Open();
    ASSERT_THAT(Migrate(*database_), IsOk());
  }
  testing::TemporaryFolder folder_;
  std::unique_ptr<Database> database_;
};

TEST_F(UserStoreTest, ATokenIsItsUserUntilItIsRevoked) {
  UserStore users(*database_);
  EXPECT_FALSE(*users.HasUsers());
  const auto tokens = users.Add({{"ada", Role::kStudent, {"lab-2", "lab-1", "lab-2"}}, {"bob", Role::kGrader, {}}});
  ASSERT_THAT(tokens, IsOk());
  ASSERT_EQ(tokens->size(), 2u);
  EXPECT_NE((*tokens)[0], (*tokens)[1]);
  const auto ada = users.Authenticate((*tokens)[0]);
  ASSERT_THAT(ada, IsOk());
  EXPECT_EQ(ada->name, "ada");
  EXPECT_EQ(ada->role, Role::kStudent);
  EXPECT_THAT(ada->groups, ElementsAre("lab-1", "lab-2"));
  EXPECT_EQ(users.Authenticate((*tokens)[1])->role, Role::kGrader);

  // By another process, while this one goes on.
  const auto elsewhere = Open();
  ASSERT_THAT(UserStore(*elsewhere).Revoke("ada"), IsOk());
  EXPECT_THAT(users.Authenticate((*tokens)[0]), StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr("revoked")));
  EXPECT_THAT(users.Authenticate((*tokens)[1]), IsOk());
  EXPECT_THAT(users.Authenticate(""), StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr("not known")));
  EXPECT_THAT(users.Revoke("eve"), StatusIs(absl::StatusCode::kNotFound, HasSubstr("\"eve\"")));
  ASSERT_THAT(users.Revoke("bob"), IsOk());
  EXPECT_TRUE(*users.HasUsers());

  const auto again = users.Add({{"ada", Role::kInstructor, {}}});
  ASSERT_THAT(again, IsOk());
  EXPECT_EQ(users.Authenticate(again->front())->role, Role::kInstructor);
  EXPECT_THAT(users.Authenticate((*tokens)[0]), StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr("not known")));
  const auto all = users.List();
  ASSERT_EQ(all->size(), 2u);
  EXPECT_FALSE((*all)[0].revoked);
  EXPECT_THAT((*all)[0].groups, IsEmpty());
  EXPECT_TRUE((*all)[1].revoked);
}

TEST_F(UserStoreTest, AllAreAddedOrNone) {
  UserStore users(*database_);
  const User ada{"ada", Role::kStudent, {}};
  EXPECT_THAT(users.Add({ada, {"Bob", Role::kStudent, {}}}, {"line 2", "line 3"}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("line 3: the user name \"Bob\"")));
  EXPECT_THAT(users.Add({ada, {"bob", Role::kStudent, {"a b"}}}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("group name \"a b\"")));
  EXPECT_THAT(users.Add({ada, ada}, {"line 2", "line 3"}),
              StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("line 3: there is a user \"ada\"")));
  EXPECT_THAT(users.Add({{std::string(65, 'a'), Role::kStudent, {}}}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("1 to 64")));
  EXPECT_FALSE(*users.HasUsers());
  EXPECT_THAT(users.Add({{std::string(64, 'a'), Role::kStudent, {}}}), IsOk());
}

TEST_F(UserStoreTest, NoTokenIsOnDisk) {
  const std::string token = UserStore(*database_).Add({{"ada", Role::kStudent, {}}})->front();
  EXPECT_EQ(token.size(), std::string("flatlight_").size() + 64);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    files += bytes.find("ada") != std::string::npos ? 1 : 0;
    EXPECT_EQ(bytes.find(token), std::string::npos) << entry.path();
  }
  EXPECT_GE(files, 1u);  // Was looked at where users are.
}

TEST(UserMigration, AnOlderFolderGetsUsersAndKeepsItsRows) {
  const testing::TemporaryFolder folder;
  const auto database = *Database::Open(Storage::DatabasePath(folder.path()));
  ASSERT_THAT(Migrate(*database, 2), IsOk());
  ASSERT_THAT(database->Execute("INSERT INTO blobs VALUES('h', 'bytes', 1);"
                                "INSERT INTO scenes(sha256, title, size) VALUES('h', 'room', 5)"),
              IsOk());
  ASSERT_THAT(Migrate(*database), IsOk());
  Statement scenes = database->Prepare("SELECT title FROM scenes");
  ASSERT_TRUE(*scenes.Step());
  EXPECT_EQ(scenes.Bytes(0), "room");
  EXPECT_FALSE(*UserStore(*database).HasUsers());
}

TEST(Roles, HaveNames) {
  for (const Role role : {Role::kStudent, Role::kGrader, Role::kInstructor, Role::kAdmin}) {
    EXPECT_EQ(RoleOf(RoleName(role)), role);
  }
  EXPECT_FALSE(RoleOf("root").has_value());
}

}  // namespace
}  // namespace flatlight
