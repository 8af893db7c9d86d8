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

  // Calls visit(limit, gate) for all walls that are seen, in the order of theta (see Edge): from the limit on, up to
  // the next call's, `gate` is seen: a wall, kNothing, or, in the last call, kHorizon. False if a direction or a place
  // cannot be decided to the accuracy of the coordinates, or if many slits let so many beams through the same triangles
  // that another way is faster; what was visited then does not count.
  template <typename Visit>
  bool Walk(const Receiver& receiver, const Visit& visit) {
    if (!Open(receiver)) return false;
    return clockwise_ ? WalkInOrder<true>(receiver, visit) : WalkInOrder<false>(receiver, visit);
  }

  // Triangles entered so far.
  double steps() const { return steps_; }

 private:
  // What is seen through a gate, up to its higher limit.
  struct Opening {
    ViewLimit high;
    Gate gate;
  };
  // A corner of the polygon around the receiver that the walk begins with, and the gate through the edge that follows,
  // counter-clockwise.
  struct Corner {
    ViewLimit to;
    bool above;
    Gate gate;
  };

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

  template <bool kClockwise, typename Visit>
  bool WalkInOrder(const Receiver& receiver, const Visit& visit);
  void Grow() { stack_.resize(2 * stack_.size()); }

  const Scene& scene_;
  const Triangulation& triangulation_;
  const double coordinate_error_;
  const double near_;   // Walls this close might pass through the receiver: they are not decided here.
  const double doubt_;  // Doubt(a, b) is never more.
  const double most_steps_;
  bool clockwise_ = false;
  ViewLimit low_;               // Of the first opening.
  std::vector<Opening> stack_;  // The next one last.
  std::size_t size_ = 0;
  double steps_ = 0;
};

template <bool kClockwise, typename Visit>
bool View::WalkInOrder(const Receiver& receiver, const Visit& visit) {
  const std::uint32_t* const triangles = triangulation_.triangles().data()->vertex;
  const Point2* const vertices = triangulation_.vertices().data();
  // Beside the opposite vertex stand the gates through the edges on its left and on its right.
  constexpr int kLow = kClockwise ? 5 : 4, kHigh = kClockwise ? 4 : 5;
  const Point2 position = receiver.position;
  const double doubt = doubt_;
  ViewLimit low = low_;
  std::size_t size = size_, steps = 0;
  while (size > 0) {
    const Opening& opening = stack_[--size];
    double high_x = opening.high.x, high_y = opening.high.y;
    std::uint32_t high_vertex = opening.high.vertex;
    Gate gate = opening.gate;
    while (gate < Triangulation::kWall) {
      const std::uint32_t* const place = triangles + gate;
      const Gate to_low = place[kLow], to_high = place[kHigh];
      const std::uint32_t apex = *place;
      const double x = vertices[apex].x - position.x, y = vertices[apex].y - position.y;
      // Positive where the apex is on the inner side of a limit.
      double from_low = low.x * y - low.y * x, to_limit = x * high_y - y * high_x;
      if constexpr (kClockwise) from_low = -from_low, to_limit = -to_limit;
      ++steps;
      if (std::min(std::abs(from_low), std::abs(to_limit)) <= doubt) [[unlikely]] {
        from_low = Side(low, {x, y, apex}, from_low);
        to_limit = Side({high_x, high_y, high_vertex}, {x, y, apex}, to_limit);
        if (from_low == 0 || to_limit == 0) return false;
      }
      if (from_low < 0) {
        gate = to_high;
      } else if (to_limit < 0) {
        gate = to_low;
      } else {
        if (size == stack_.size()) Grow();
        stack_[size++] = {{high_x, high_y, high_vertex}, to_high};
        __builtin_prefetch(triangles + (to_high < Triangulation::kWall ? to_high : 0));
        high_x = x, high_y = y, high_vertex = apex, gate = to_low;
      }
    }
    if (gate == Triangulation::kShared || static_cast<double>(steps) > most_steps_) {
      steps_ += static_cast<double>(steps);
      return false;
    }
    visit(low, gate);
    low = {high_x, high_y, high_vertex};
  }
  visit(low, Triangulation::kHorizon);
  steps_ += static_cast<double>(steps);
  return true;
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_TRIANGULATION_VIEW_H_
