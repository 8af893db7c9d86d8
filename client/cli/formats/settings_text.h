// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_SETTINGS_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_SETTINGS_TEXT_H_

#include <string>

#include "flatlight/v1/settings.pb.h"

namespace flatlight {

// The settings that are set, as options: "--method path-tracing --samples 1024".
std::string SettingsText(const v1::Settings& settings);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_SETTINGS_TEXT_H_
