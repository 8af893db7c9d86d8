// SPDX-License-Identifier: Apache-2.0
// Cache records between a rendering and its results.
#ifndef FLATLIGHT_CORE_RENDER_RECORD_EXCHANGE_H_
#define FLATLIGHT_CORE_RENDER_RECORD_EXCHANGE_H_

#include <optional>

#include "core/cache/record.h"
#include "core/plane/irradiance_caching/track.h"
#include "core/render/field.h"
#include "core/scene/scene.h"

namespace flatlight {

RecordField ToWorld(const CacheRecord& record, const Track& track, const Scene& scene);

// The record on its track, without errors, footprint and events; absent if it lies on none, or beyond the points that
// are wanted there, where a wall may be between. `record` may come from anywhere: it is absent too if it does not lie
// where it says.
std::optional<CacheRecord> FromWorld(const RecordField& record, const Tracks& tracks, const Scene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_RECORD_EXCHANGE_H_
