// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_GUARD_H_
#define FLATLIGHT_SERVER_SERVICE_GUARD_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "grpcpp/server_context.h"
#include "server/quota/quotas.h"
#include "server/quota/request_buckets.h"
#include "server/service/policy.h"
#include "server/store/user_directory.h"

namespace flatlight {

// Passed by every call of every flatlight service before anything else: who calls, and may they? (Health and reflection
// are open.)
//
// - kServerOwner, an admin, is who sends the server's own token.
// - Whoever sends the token of a user is that user, from the moment it is added until it is revoked.
// - kAnonymous, an admin, is everybody on this machine, while the server has no token of its own and has never had a
//   user. Both names are kept from users.
class Guard {
 public:
  // Callers send "authorization: Bearer TOKEN". `token`: the server's own; empty: none. `users`: a connection for the
  // guard alone; null: no users.
  // `quotas` and `clock` outlive this.
  Guard(const std::string& token, std::unique_ptr<Database> users, const QuotaTable& quotas, const Clock& clock);

  // Whether nobody can be kAnonymous, now and from now on.
  absl::StatusOr<bool> KnowsEverybody() const;

  // UNAUTHENTICATED with BAD_TOKEN or TOKEN_INVALID.
  absl::StatusOr<Caller> Identify(const grpc::ServerContextBase& context) const;
  // Takes a request of the caller's. PERMISSION_DENIED with ROLE_TOO_LOW, RESOURCE_EXHAUSTED with TOO_MANY_REQUESTS.
  // `request`: see PolicyRow.
  absl::Status Admit(const Caller& caller, std::string_view request) const;

  // Of a call that goes on: whether its caller would still be known. As Identify; PERMISSION_DENIED for who is not
  // the same any more.
  absl::Status Recheck(const Caller& caller) const;
  // Changes whenever Recheck may have another answer (and when it has not: with any change of the users' database).
  std::int64_t UsersVersion() const;

  const Quotas& QuotasOf(Role role) const { return quotas_.Of(role); }
  const Quotas& QuotasOf(const Caller& caller) const { return quotas_.Of(caller.role); }
  // Of who made a job in a process before.
  const Quotas& QuotasOf(const std::string& owner) const;
  // How many of the requests that the caller may make at once it has made.
  double RequestsTaken(const Caller& caller) const;

 private:
  absl::StatusOr<bool> HasUsers() const;
  absl::Status TakeRequest(const Caller& caller) const;

  const std::string token_hash_;                // Empty: no token.
  const std::unique_ptr<UserDirectory> users_;  // Null: none.
  const QuotaTable& quotas_;
  mutable RequestBuckets requests_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_GUARD_H_
