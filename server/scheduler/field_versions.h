// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_FIELD_VERSIONS_H_
#define FLATLIGHT_SERVER_SCHEDULER_FIELD_VERSIONS_H_

#include <cstdint>

#include "core/render/field.h"
#include "core/scene/scene.h"
#include "server/store/job.h"

namespace flatlight {

// The versions of `after`, which state `sequence` brings: `before_versions` where its bits equal those of `before`
// (null: there was no field), `sequence` elsewhere.
FieldVersions StampVersions(const SceneOutline& scene, const Field* before, const FieldVersions& before_versions,
                            const Field& after, std::uint64_t sequence);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_FIELD_VERSIONS_H_
