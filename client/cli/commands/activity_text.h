// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_ACTIVITY_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_ACTIVITY_TEXT_H_

#include <cstddef>
#include <string>

#include "flatlight/v1/server_service.pb.h"

namespace flatlight {

// What a server does, as `flatlight top` shows it: totals, users, jobs. Rates are those from `before` to `now`, two
// answers of one server. At most `width` columns, and `height` lines (0: as many as it takes).
std::string ActivityText(const std::string& server, const v1::GetCapabilitiesResponse& capabilities,
                         const v1::GetActivityResponse& before, const v1::GetActivityResponse& now, std::size_t width,
                         std::size_t height);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_ACTIVITY_TEXT_H_
