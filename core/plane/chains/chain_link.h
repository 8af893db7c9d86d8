// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_LINK_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_LINK_H_

#include "core/scene/scene.h"

namespace flatlight {

// A mirror or a piece of glass on the way of a ray.
struct ChainLink {
  ElementId element = ElementId::kNone;
  bool far = false;      // Met where a ray leaves its circle, not where it enters it.
  bool crosses = false;  // Light goes through, and is not reflected.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_LINK_H_
