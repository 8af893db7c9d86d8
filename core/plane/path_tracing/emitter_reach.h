// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_REACH_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_REACH_H_

#include <cstddef>
#include <vector>

#include "core/scene/scene.h"

namespace flatlight {

// Which emitting pieces can light what directly, as far as shapes tell. An emitter is unseen from a place if the place
// lies behind it, or it lies below the place's horizon, or one straight piece hides it.
struct EmitterReach {
  struct Piece {
    ElementId id = ElementId::kNone;
    bool lights_points = true;      // Some point of a probe.
    bool lights_reflectors = true;  // Some curve that reflects.
  };
  std::vector<Piece> pieces;  // All that emit, in the order of elements.
  // Of a place (a piece that reflects or holds points, or a point) and an emitting piece that it may see: how many were
  // looked at, and between how many of them nothing stands.
  std::size_t ways = 0;
  std::size_t clear_ways = 0;

  bool LightsReflectors() const;
  // Whether light of a piece counts. `direct`: none is reflected.
  static bool Counts(const Piece& piece, bool direct) {
    return piece.lights_points || (!direct && piece.lights_reflectors);
  }
};

// Takes time in proportion to the number of elements at most, and well under a millisecond in addition: what has not
// been looked at by then counts as lit. In a scene too large to build a tree for this nothing is known to hide
// anything.
EmitterReach ReachOfEmitters(const Scene& scene);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_EMITTER_REACH_H_
