// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_EXACT_FIELD_H_
#define FLATLIGHT_CORE_RENDER_EXACT_FIELD_H_

#include <cstddef>

#include "core/plane/exact/exact.h"
#include "core/render/field.h"
#include "core/render/world_units.h"

namespace flatlight {

// Appends a point's derivatives and the bounds on their errors, as far as they were asked for, in world units.
inline void AppendDerivatives(const ExactValue& value, std::size_t channels, int derivatives, const WorldUnits& units,
                              ProbeField& field) {
  for (std::size_t c = 0; c < channels; ++c) {
    if (derivatives < 1) return;
    field.gradient.push_back(units.gradient * value.gradient.value[c]);
    field.gradient_error.push_back(units.gradient * value.gradient_error.value[c]);
    if (derivatives < 2) continue;
    field.hessian.push_back(units.hessian * value.hessian.value[c]);
    field.hessian_error.push_back(units.hessian * value.hessian_error.value[c]);
  }
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_EXACT_FIELD_H_
