// SPDX-License-Identifier: Apache-2.0
// Results that were written, as what they were made from: the way back of result_convert.h.
#ifndef FLATLIGHT_SERVER_CONVERT_RESULT_READ_H_
#define FLATLIGHT_SERVER_CONVERT_RESULT_READ_H_

#include <optional>

#include "core/render/field.h"
#include "core/render/rendering.h"
#include "flatlight/v1/result.pb.h"
#include "server/store/scene_outline.h"

namespace flatlight {

// ResultToProto of the two gives `result` again. The outline's frame is that of the world.
SceneOutline OutlineOf(const v1::RenderResult& result);
Field FieldOf(const v1::RenderResult& result);
// Nothing for END_REASON_UNSPECIFIED.
std::optional<EndReason> EndReasonFromProto(v1::EndReason reason);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_RESULT_READ_H_
