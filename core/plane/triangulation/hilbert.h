// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_TRIANGULATION_HILBERT_H_
#define FLATLIGHT_CORE_PLANE_TRIANGULATION_HILBERT_H_

#include <cstdint>

#include "core/math/vec.h"
#include "core/plane/box.h"

namespace flatlight {

// A place's number along a Hilbert curve that fills the box, in 2^32 steps: what is near on the curve is near in the
// plane. Points outside count as the nearest ones inside.
std::uint32_t HilbertKey(const Box& box, Point2 p);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_TRIANGULATION_HILBERT_H_
