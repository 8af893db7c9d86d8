// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_FIELD_CHECK_H_
#define FLATLIGHT_SERVER_SCHEDULER_FIELD_CHECK_H_

#include "absl/status/status.h"
#include "core/render/field.h"
#include "server/store/scene_outline.h"

namespace flatlight {

// INTERNAL if the field holds infinities or NaNs, which no reader could use; names the first one's place.
absl::Status CheckFinite(const SceneOutline& scene, const Field& field);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_FIELD_CHECK_H_
