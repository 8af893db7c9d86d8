// SPDX-License-Identifier: Apache-2.0
// The lanes of a node in vector code: included once for every vector unit.
#if defined(FLATLIGHT_CORE_PLANE_NODE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FLATLIGHT_CORE_PLANE_NODE_LANES_INL_H_
#undef FLATLIGHT_CORE_PLANE_NODE_LANES_INL_H_
#else
#define FLATLIGHT_CORE_PLANE_NODE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "core/plane/bvh.h"
#include "core/plane/mask_byte.h"

HWY_BEFORE_NAMESPACE();
namespace flatlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, BvhNode::kWidth>;
using Integers = hn::Rebind<std::int32_t, Floats>;
inline constexpr std::size_t kLanes = hn::MaxLanes(Floats());  // At once: 8 are a node; 4, or 1.

// Numbers of the grid as floats.
HWY_INLINE hn::Vec<Floats> LoadNumbers(const std::uint8_t* numbers) {
  return hn::ConvertTo(Floats(), hn::PromoteTo(Integers(), hn::Load(hn::Rebind<std::uint8_t, Floats>(), numbers)));
}

HWY_INLINE unsigned BitsOf(hn::Mask<Floats> mask) {
  std::uint8_t bits[8];
  hn::StoreMaskBits(Floats(), mask, bits);
  return NumberOf(bits[0]);
}

}  // namespace HWY_NAMESPACE
}  // namespace flatlight
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for every vector unit
