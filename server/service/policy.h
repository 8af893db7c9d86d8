// SPDX-License-Identifier: Apache-2.0
// Who may call what: the one table that every call is held against.
#ifndef FLATLIGHT_SERVER_SERVICE_POLICY_H_
#define FLATLIGHT_SERVER_SERVICE_POLICY_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "server/store/user_store.h"

namespace flatlight {

struct Caller {
  std::string name;
  Role role = Role::kStudent;
  std::vector<std::string> groups = {};
};

// Each RPC has a request message of its own, by whose name it is found.
struct PolicyRow {
  std::string_view request;  // "CreateJobRequest", of flatlight.v1.
  Role least;                // Who has less is refused.
};
const std::vector<PolicyRow>& Policy();

// OK, or PERMISSION_DENIED with ROLE_TOO_LOW; also where the table has no row.
absl::Status CheckRole(const Caller& caller, std::string_view request);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_POLICY_H_
