// SPDX-License-Identifier: Apache-2.0
#include "core/plane/triangulation/view.h"

#include "core/math/check.h"

namespace flatlight {
namespace {

double Reach(const ViewLimit& limit) { return std::abs(limit.x) + std::abs(limit.y); }

// No sum of a vector's components is larger, inside the mesh.
constexpr double kMostReach = 4 * PlanarCuts::kHalf;

// Triangles entered, by their number: more than once where beams part before them.
constexpr double kMostEntries = 8;

}  // namespace

View::View(const Scene& scene, const Triangulation& triangulation)
    : scene_(scene),
      triangulation_(triangulation),
      coordinate_error_(scene.coordinate_error()),
      near_(kOnwardTouches * scene.touch_distance()),
      doubt_(12 * triangulation.most_uncertain() * kMostReach + 32 * kUnitRoundoff * kMostReach * kMostReach),
      most_steps_(kMostEntries * static_cast<double>(triangulation.triangles().size())),
      stack_(64) {
  FLATLIGHT_DCHECK(triangulation.coordinate_error() == coordinate_error_);
}

double View::Doubt(const ViewLimit& a, const ViewLimit& b) const {
  // As for the ends of sights: the direction to each turns by what its place is off over its distance.
  const double reach_a = Reach(a), reach_b = Reach(b);
  const double off_a = triangulation_.Uncertain(a.vertex), off_b = triangulation_.Uncertain(b.vertex);
  return 6 * (off_a * reach_b + off_b * reach_a) + 32 * kUnitRoundoff * reach_a * reach_b;
}

int View::Side(const ViewLimit& limit, const ViewLimit& vertex, double cross) const {
  if (limit.vertex != ViewLimit::kHorizon) {
    if (limit.vertex == vertex.vertex || std::abs(cross) <= Doubt(limit, vertex)) return 0;
    return cross > 0 ? 1 : -1;
  }
  // `cross` is the height above the horizon. What lies at it counts as below; crossings with the receiver's own line
  // do, however far along it they are off.
  const double uncertain = 2 * coordinate_error_ + 4 * kUnitRoundoff * Reach(vertex);
  if (cross <= uncertain) return -1;
  return cross > 3 * uncertain + 2 * triangulation_.Uncertain(vertex.vertex) ? 1 : 0;
}

bool View::SetCorner(const Receiver& receiver, std::uint32_t vertex, Gate gate, Corner& corner) const {
  const Vector2 to = triangulation_.vertices()[vertex] - receiver.position;
  corner.to = {to.x, to.y, vertex};
  corner.gate = gate;
  const int side = Side(ViewLimit{}, corner.to, Dot(receiver.normal, to));
  corner.above = side > 0;
  return side != 0 && Reach(corner.to) > near_;
}

bool View::IsInside(const Corner& from, const Corner& to) const {
  const double area = from.to.x * to.to.y - from.to.y * to.to.x;
  if (!(area > Doubt(from.to, to.to))) return false;
  return from.gate < Triangulation::kWall ||
         area > near_ * (std::abs(to.to.x - from.to.x) + std::abs(to.to.y - from.to.y));
}

bool View::Open(const Receiver& receiver) {
  clockwise_ = Cross(receiver.tangent, receiver.normal) > 0;
  const std::vector<Triangulation::Triangle>& triangles = triangulation_.triangles();
  Corner corners[4];
  const auto set = [&](int corner, const Triangulation::Triangle& triangle, std::uint32_t vertex, Gate gate) {
    return SetCorner(receiver, triangle.vertex[vertex % 3], gate, corners[corner]);
  };
  if (receiver.element != ElementId::kNone) {
    const Element& own = scene_.element(receiver.element);
    const bool front = Cross(own.b - own.a, receiver.normal) > 0;
    const Gate gate = triangulation_.GateAt(scene_, receiver.element, receiver.position, front);
    if (gate >= Triangulation::kWall) return false;
    const Triangulation::Triangle& triangle = triangles[gate / Triangulation::kTriangle];
    const std::uint32_t apex = gate % Triangulation::kTriangle;
    // The edge it lies on follows the last corner.
    set(0, triangle, apex + 2, triangle.gate[apex + 1]);
    set(2, triangle, apex + 1, Triangulation::kNothing);
    if (!set(1, triangle, apex, triangle.gate[apex + 2])) return false;
    const Vector2 edge = own.b - own.a;
    for (const int end : {0, 2}) {
      const Vector2 to{corners[end].to.x, corners[end].to.y};
      // On the right side of the receiver, and apart from it.
      const double ahead = Dot(to, edge) / own.length * ((end == 0) == front ? 1 : -1);
      if (!(ahead > near_)) return false;
      corners[end].above = false;
    }
    return IsInside(corners[0], corners[1]) && IsInside(corners[1], corners[2]) && OpenAround(receiver, corners, 3);
  }
  const std::uint32_t found = triangulation_.Locate(scene_, receiver.position);
  if (found == Triangulation::kNone) return false;
  const Triangulation::Triangle& triangle = triangles[found];
  for (std::uint32_t k = 0; k < 3; ++k)
    if (!set(static_cast<int>(k), triangle, k, triangle.gate[k + 2])) return false;
  std::uint32_t on = 3;
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (IsInside(corners[k], corners[(k + 1) % 3])) continue;
    if (on != 3) return false;
    on = k;
  }
  if (on == 3) return OpenAround(receiver, corners, 3);
  // On an edge: begin with the triangles on both sides of it.
  const Gate across = corners[on].gate;
  if (across >= Triangulation::kWall) return false;
  const Triangulation::Triangle& other = triangles[across / Triangulation::kTriangle];
  const std::uint32_t apex = across % Triangulation::kTriangle;
  if (!set(0, triangle, on, other.gate[apex + 1]) || !set(1, other, apex, other.gate[apex + 2]) ||
      !set(2, triangle, on + 1, triangle.gate[on]) || !set(3, triangle, on + 2, triangle.gate[on + 1]))
    return false;
  for (int k = 0; k < 4; ++k)
    if (!IsInside(corners[k], corners[(k + 1) % 4])) return false;
  return OpenAround(receiver, corners, 4);
}

bool View::OpenAround(const Receiver& receiver, const Corner* corners, int count) {
  // In the order of theta, from the edge in which it rises above the horizon.
  const int step = clockwise_ ? count - 1 : 1;
  int first = 0;
  while (first < count && (corners[first].above || !corners[(first + step) % count].above)) ++first;
  if (first == count) return false;
  Opening openings[4];
  int opened = 0;
  for (int from = first; opened < count; from = (from + step) % count) {
    const int to = (from + step) % count;
    Opening& opening = openings[opened++];
    opening.gate = corners[clockwise_ ? to : from].gate;
    __builtin_prefetch(triangulation_.triangles().data()->vertex +
                       (opening.gate < Triangulation::kWall ? opening.gate : 0));
    if (!corners[to].above) {
      opening.high = {receiver.tangent.x, receiver.tangent.y, ViewLimit::kHorizon};
      break;
    }
    opening.high = corners[to].to;
  }
  if (openings[opened - 1].high.vertex != ViewLimit::kHorizon) return false;
  low_ = {-receiver.tangent.x, -receiver.tangent.y, ViewLimit::kHorizon};
  size_ = 0;
  while (opened > 0) stack_[size_++] = openings[--opened];
  return true;
}

}  // namespace flatlight
