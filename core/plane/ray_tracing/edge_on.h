// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_RAY_TRACING_EDGE_ON_H_
#define FLATLIGHT_CORE_PLANE_RAY_TRACING_EDGE_ON_H_

#include <array>
#include <span>

#include "core/plane/exact/edge.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// A straight piece that a receiver sees edge-on: rays may all miss it, and yet it changes derivatives, for its near end
// moves faster than its far end as the receiver moves.
struct EdgeOnPiece {
  ElementId element = ElementId::kNone;
  Edge low, high;   // Its ends by their sines; where these are equal, as they part when the receiver moves on.
  double size = 0;  // What it changes the gradient by, for a difference of 1 in radiance.
  Hit middle;       // As a ray would meet it.
  Vector2 toward;   // Of that ray, on the side that is seen as the receiver moves on.
};

class EdgeOnPieces {
 public:
  // Those that are narrower than one of `rays` equal stretches of the hemicircle may be, the largest ones first to be
  // kept, in order of their sines. None of scenes so large that looking at every element would take longer than rays
  // do.
  EdgeOnPieces(const RayCaster& caster, const Receiver& receiver, std::uint32_t rays);

  std::span<const EdgeOnPiece> pieces() const { return std::span(pieces_).first(count_); }

 private:
  static constexpr std::size_t kMost = 4;

  void Keep(const EdgeOnPiece& piece);

  std::array<EdgeOnPiece, kMost> pieces_;
  std::size_t count_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_RAY_TRACING_EDGE_ON_H_
