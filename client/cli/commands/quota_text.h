// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_QUOTA_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_QUOTA_TEXT_H_

#include <string>

#include "flatlight/v1/server_service.pb.h"

namespace flatlight {

// What a user has and may have of a server, as a table.
std::string QuotaText(const v1::Quotas& quotas);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_QUOTA_TEXT_H_
