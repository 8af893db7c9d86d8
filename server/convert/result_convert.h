// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_RESULT_CONVERT_H_
#define FLATLIGHT_SERVER_CONVERT_RESULT_CONVERT_H_

#include <cstddef>

#include "core/render/field.h"
#include "core/render/rendering.h"
#include "flatlight/v1/render_service.pb.h"
#include "flatlight/v1/result.pb.h"
#include "flatlight/v1/scene_service.pb.h"
#include "server/store/scene_outline.h"

namespace flatlight {

// Fill the fields for points [first, first + count) of a probe; world units.
void FillProbeGeometry(const SceneOutline& scene, std::size_t probe, std::size_t first, std::size_t count,
                       v1::ProbeResult& out);
void FillProbeValues(const Field& field, int channels, std::size_t probe, std::size_t first, std::size_t count,
                     v1::ProbeResult& out);

// All probes, both of the above, and error_bound and rays. The caller fills in what it alone knows: job key, build,
// settings, plan, times, end reason.
v1::RenderResult ResultToProto(const SceneOutline& scene, const Field& field);
v1::EndReason EndReasonToProto(EndReason reason);
v1::SceneTraits TraitsToProto(const SceneTraits& traits);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_RESULT_CONVERT_H_
