// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_QUOTA_CALLS_H_
#define FLATLIGHT_SERVER_SERVICE_QUOTA_CALLS_H_

#include <cstdint>
#include <string>

#include "flatlight/v1/server_service.pb.h"
#include "server/service/backend.h"

namespace flatlight {

// How many bytes the scenes and jobs of a user take. From memory.
std::uint64_t StorageOf(Backend& backend, const std::string& user);
// What the caller may have, and has. From memory.
void FillQuotas(Backend& backend, const Caller& caller, v1::Quotas& all);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_QUOTA_CALLS_H_
