// SPDX-License-Identifier: Apache-2.0
// What others than its owner may do with something.
#ifndef FLATLIGHT_SERVER_STORE_GRANTS_H_
#define FLATLIGHT_SERVER_STORE_GRANTS_H_

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"

namespace flatlight {

enum class Access : std::uint8_t { kRead, kControl };  // Each includes those before.

// A user, a group of users, or everybody whom the server lets in.
class Grantee {
 public:
  // From "user:NAME", "group:NAME" or "course"; nothing if the text has another form. That there is such a user or
  // group is not asked: who may share would learn who is here.
  static std::optional<Grantee> Parse(std::string_view text);
  // All that a user is.
  static std::vector<Grantee> Of(const std::string& user, const std::vector<std::string>& groups);

  const std::string& text() const { return text_; }
  friend auto operator<=>(const Grantee&, const Grantee&) = default;

 private:
  explicit Grantee(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

struct Grant {
  Grantee grantee;
  Access access = Access::kRead;
  friend bool operator==(const Grant&, const Grant&) = default;
};

// What `grants` allow to one who is all of `who`; nothing: nothing.
std::optional<Access> AccessOf(const std::vector<Grant>& grants, const std::vector<Grantee>& who);

// A list of grants is sorted by grantee and has each once.
inline constexpr std::size_t kMaxGrants = 100;
// In place of one with the same grantee. RESOURCE_EXHAUSTED with TOO_MANY_SHARES; `place` says of what.
absl::Status AddGrant(const std::string& place, const Grant& grant, std::vector<Grant>& grants);
// NOT_FOUND with SHARE_NOT_FOUND.
absl::Status RemoveGrant(const std::string& place, const Grantee& grantee, std::vector<Grant>& grants);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_GRANTS_H_
