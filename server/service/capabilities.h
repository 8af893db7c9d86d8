// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_CAPABILITIES_H_
#define FLATLIGHT_SERVER_SERVICE_CAPABILITIES_H_

#include <array>
#include <string>

#include "grpcpp/support/byte_buffer.h"
#include "server/service/backend.h"

namespace flatlight {

// ServerService.GetCapabilities. Every client asks first: what does not change is serialised once.
class Capabilities {
 public:
  // `backend` outlives this.
  explicit Capabilities(Backend& backend);

  // A serialised GetCapabilitiesResponse: what callers of that role are told, and the caller's quotas.
  grpc::ByteBuffer For(const Caller& caller) const;

 private:
  Backend& backend_;
  std::array<std::string, kRoles> fixed_;  // By role.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_CAPABILITIES_H_
