// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_SETTINGS_CONVERT_H_
#define FLATLIGHT_SERVER_CONVERT_SETTINGS_CONVERT_H_

#include "core/render/plan.h"
#include "core/render/settings.h"
#include "core/scene/diagnostic.h"
#include "flatlight/v1/settings.pb.h"

namespace flatlight {

// Unknown fields and enum values are mistakes; ranges are checked by MakePlan.
Settings SettingsFromProto(const v1::Settings& proto, Diagnostics& diagnostics);
v1::Settings SettingsToProto(const Settings& settings);
v1::Plan PlanToProto(const Plan& plan);
// What callers see of a plan: enough to show it, not to render by it.
Plan PlanFromProto(const v1::Plan& proto);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_SETTINGS_CONVERT_H_
