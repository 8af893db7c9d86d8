// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_PLAN_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_PLAN_TEXT_H_

#include <string>

#include "flatlight/v1/settings.pb.h"

namespace flatlight {

// Before a render: what will be done, and what is left out.
std::string ShortPlanText(const v1::Plan& plan);

// For `explain`: settings, passes with their expected cost, every skip with its reason.
std::string PlanText(const v1::Plan& plan);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_PLAN_TEXT_H_
