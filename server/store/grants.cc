// SPDX-License-Identifier: Apache-2.0
#include "server/store/grants.h"

#include <algorithm>
#include <chrono>

#include "server/store/error.h"
#include "server/store/user_store.h"

namespace flatlight {
namespace {

constexpr std::string_view kUser = "user:";
constexpr std::string_view kGroup = "group:";
constexpr std::string_view kCourse = "course";

auto PlaceOf(const Grantee& grantee, std::vector<Grant>& grants) {
  return std::lower_bound(grants.begin(), grants.end(), grantee,
                          [](const Grant& grant, const Grantee& other) { return grant.grantee < other; });
}

}  // namespace

std::optional<Grantee> Grantee::Parse(std::string_view text) {
  for (const std::string_view kind : {kUser, kGroup}) {
    if (text.starts_with(kind) && IsUserName(text.substr(kind.size()))) return Grantee(std::string(text));
  }
  if (text == kCourse) return Grantee(std::string(text));
  return std::nullopt;
}

std::vector<Grantee> Grantee::Of(const std::string& user, const std::vector<std::string>& groups) {
  std::vector<Grantee> all = {Grantee(std::string(kCourse)), Grantee(std::string(kUser) + user)};
  for (const std::string& group : groups) all.push_back(Grantee(std::string(kGroup) + group));
  return all;
}

std::optional<Access> AccessOf(const std::vector<Grant>& grants, const std::vector<Grantee>& who) {
  std::optional<Access> access;
  for (const Grant& grant : grants) {
    if (std::find(who.begin(), who.end(), grant.grantee) == who.end()) continue;
    access = std::max(access.value_or(Access::kRead), grant.access);
  }
  return access;
}

absl::Status AddGrant(const std::string& place, const Grant& grant, std::vector<Grant>& grants) {
  const auto at = PlaceOf(grant.grantee, grants);
  if (at != grants.end() && at->grantee == grant.grantee) {
    at->access = grant.access;
    return absl::OkStatus();
  }
  if (grants.size() >= kMaxGrants) {
    return MakeError(absl::StatusCode::kResourceExhausted, "TOO_MANY_SHARES",
                     place + " is shared with " + std::to_string(grants.size()) +
                         " users and groups; allowed: " + std::to_string(kMaxGrants) + "; share it with a group");
  }
  grants.insert(at, grant);
  return absl::OkStatus();
}

absl::Status RemoveGrant(const std::string& place, const Grantee& grantee, std::vector<Grant>& grants) {
  const auto at = PlaceOf(grantee, grants);
  if (at == grants.end() || at->grantee != grantee) {
    return MakeError(absl::StatusCode::kNotFound, "SHARE_NOT_FOUND", place + " is not shared with " + grantee.text());
  }
  grants.erase(at);
  return absl::OkStatus();
}

}  // namespace flatlight
