// SPDX-License-Identifier: Apache-2.0
// What a receiver sees above its horizon, by going through the triangles that it sees: from each through those of its
// other edges that are seen, to the walls. Triangular expansion: Bungiu et al. 2014, "Efficient Computation of
// Visibility Polygons" (arXiv:1403.3905).
#ifndef FLATLIGHT_CORE_PLANE_TRIANGULATION_VIEW_H_
#define FLATLIGHT_CORE_PLANE_TRIANGULATION_VIEW_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/math/tolerances.h"
#include "core/math/vec.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/scene/scene.h"

namespace flatlight {

// A direction in which something visible begins or ends: toward a vertex, or along the horizon.
struct ViewLimit {
  static constexpr std::uint32_t kHorizon = 0xffffffff;
  double x = 0;  // From the receiver.
  double y = 0;
  std::uint32_t vertex = kHorizon;
};

// Holds working memory: one for each thread.
class View {
 public:
  // Both must outlive it.
  View(const Scene& scene, const Triangulation& triangulation);

  // Calls visit(vertex, gate) for all walls that are seen, in the order of theta (see Edge): from the direction to the
  // vertex on, up to the next call's, `gate` is seen: a wall, or kNothing. The first call has the horizon for a vertex,
  // as has the last, of which the gate is kHorizon. False, and nothing is visited, if a direction or a place cannot be
  // decided to the accuracy of the coordinates, or if many slits let so many beams through the same triangles that
  // another way is faster.
  template <typename Visit>
  bool Walk(const Receiver& receiver, const Visit& visit) {
    if (!Find(receiver)) return false;
    std::uint32_t low = ViewLimit::kHorizon;
    for (std::uint32_t i = 0; i != kNoStretch; i = stretches_[i].next) {
      visit(low, stretches_[i].gate);
      low = stretches_[i].high;
    }
    visit(low, Triangulation::kHorizon);
    return true;
  }

  // Triangles entered so far.
  double steps() const { return steps_; }

 private:
  static constexpr std::uint32_t kNoStretch = 0xffffffff;
  // What is seen from the stretch before up to a vertex: behind the gate, in the end a wall.
  struct Stretch {
    std::uint32_t high;
    Gate gate;
    std::uint32_t next;  // The stretch that begins there; those that follow the first make up all that is seen.
  };
  // A stretch of which the walls are still to be found.
  struct Beam {
    ViewLimit low;
    ViewLimit high;
    Gate gate;
    std::uint32_t stretch;
  };
  // A corner of the polygon around the receiver that the walk begins with, and the gate through the edge that follows,
  // counter-clockwise.
  struct Corner {
    ViewLimit to;
    bool above;
    Gate gate;
  };

  // Finds the stretches.
  bool Find(const Receiver& receiver);
  // Finds the gates around the receiver that lead above its horizon.
  bool Open(const Receiver& receiver);
  bool OpenAround(const Receiver& receiver, const Corner* corners, int count);
  bool SetCorner(const Receiver& receiver, std::uint32_t vertex, Gate gate, Corner& corner) const;
  double Doubt(const ViewLimit& a, const ViewLimit& b) const;
  // Whether the receiver lies beyond doubt on the left of the edge between two corners, and off it if it is a wall.
  bool IsInside(const Corner& from, const Corner& to) const;

  // Where the fast comparison does not decide: +1 if the vertex lies on the inner side of a limit, -1 if on the outer
  // one, 0 if that is uncertain.
  int Side(const ViewLimit& limit, const ViewLimit& vertex, double cross) const;

  // Puts a stretch, and the beam that looks for its walls, after all others.
  void Append(const ViewLimit& low, const ViewLimit& high, Gate gate);
  void MakeRoom();
  // Follows the beams from triangle to triangle, to walls.
  template <bool kClockwise>
  bool Follow(Point2 position);

  const Scene& scene_;
  const Triangulation& triangulation_;
  const double coordinate_error_;
  const double near_;   // Walls this close might pass through the receiver: they are not decided here.
  const double doubt_;  // Doubt(a, b) is never more.
  const double most_steps_;
  bool clockwise_ = false;
  // With room for more than there are.
  std::vector<Stretch> stretches_;
  std::vector<Beam> beams_;
  std::size_t stretch_count_ = 0;
  std::size_t beam_count_ = 0;
  double steps_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_TRIANGULATION_VIEW_H_
