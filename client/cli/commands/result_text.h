// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_TEXT_H_

#include <string>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

// After a render: range of irradiance and largest error of each probe, rays, time, and why it ended.
std::string ResultText(const v1::RenderResult& result);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_RESULT_TEXT_H_
