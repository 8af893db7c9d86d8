// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_ACTIVITY_H_
#define FLATLIGHT_SERVER_SERVICE_ACTIVITY_H_

#include "absl/status/statusor.h"
#include "flatlight/v1/server_service.pb.h"
#include "server/service/backend.h"

namespace flatlight {

// ServerService.GetActivity.
absl::StatusOr<v1::GetActivityResponse> GetActivity(Backend& backend, const Caller& caller,
                                                    const v1::GetActivityRequest& request);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_ACTIVITY_H_
