// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_USER_STORE_H_
#define FLATLIGHT_SERVER_STORE_USER_STORE_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/database.h"

namespace flatlight {

// In the order of what they may do.
enum class Role { kStudent, kGrader, kInstructor, kAdmin };
inline constexpr std::size_t kRoles = 4;

std::string_view RoleName(Role role);
std::vector<std::string> RoleNames();  // In that order.
std::optional<Role> RoleOf(std::string_view name);

// Callers that are no users: everybody, where nobody needs a token; who has the server's own token.
inline constexpr std::string_view kAnonymous = "anonymous";
inline constexpr std::string_view kServerOwner = "owner";

struct User {
  std::string name;  // 1 to 64 of a-z, 0-9 and . _ - @, the first a letter or digit; not kAnonymous, not kServerOwner.
  Role role = Role::kStudent;
  std::vector<std::string> groups;  // Named as users are; sorted, each once.
  bool revoked = false;             // Has no token.
};

// Whether a user, or a group, may be named so.
bool IsUserName(std::string_view name);

// The users of a server and the hashes of their tokens. A token is 256 random bits, shown once, to whoever makes it.
// Several processes may each have one of these on the same file; like its database, for one thread at a time.
class UserStore {
 public:
  explicit UserStore(Database& database) : database_(database) {}

  // All of them or, on an error, none; gives their tokens, in order. A revoked user may be added again.
  // INVALID_ARGUMENT with USER_INVALID, or ALREADY_EXISTS with USER_EXISTS; `places[i]`, if given, says where users[i]
  // was written.
  absl::StatusOr<std::vector<std::string>> Add(const std::vector<User>& users,
                                               const std::vector<std::string>& places = {});
  // By name.
  absl::StatusOr<std::vector<User>> List();
  // From now on the token is worth nothing; the name stays taken, as the owner of what it made. NOT_FOUND with
  // USER_NOT_FOUND.
  absl::Status Revoke(const std::string& name);
  // UNAUTHENTICATED with TOKEN_INVALID.
  absl::StatusOr<User> Authenticate(std::string_view token);
  absl::StatusOr<User> FindByTokenHash(const std::string& token_sha256);  // In lower-case hexadecimal.
  // Of a user, revoked or not; nothing if there is none of that name.
  absl::StatusOr<std::optional<Role>> FindRole(const std::string& name);
  // Whether there have ever been users: revoking the last one opens nothing to strangers.
  absl::StatusOr<bool> HasUsers();

 private:
  absl::StatusOr<std::string> AddOne(const User& user, const std::string& place);
  absl::StatusOr<std::vector<std::string>> GroupsOf(const std::string& name);

  Database& database_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_USER_STORE_H_
