// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_GUARD_H_
#define FLATLIGHT_SERVER_SERVICE_GUARD_H_

#include <string>

#include "absl/status/statusor.h"
#include "grpcpp/server_context.h"

namespace flatlight {

struct Caller {
  std::string name;
};

// Passed by every call of every flatlight service before anything else: who calls, and may they? (Health and reflection
// are open.)
class Guard {
 public:
  // With a token, only callers that send "authorization: Bearer TOKEN" pass. Empty: everybody does.
  explicit Guard(const std::string& token);

  absl::StatusOr<Caller> Authorize(const grpc::ServerContextBase& context) const;

 private:
  std::string token_hash_;  // Empty: no token is asked for.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_GUARD_H_
