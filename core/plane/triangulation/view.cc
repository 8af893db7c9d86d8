// SPDX-License-Identifier: Apache-2.0
#include "core/plane/triangulation/view.h"

#include <utility>

#include "core/math/check.h"

namespace flatlight {
namespace {

double Reach(const ViewLimit& limit) { return std::abs(limit.x) + std::abs(limit.y); }

// No sum of a vector's components is larger, inside the mesh.
constexpr double kMostReach = 4 * PlanarCuts::kHalf;

// Triangles entered, by their number: more than once where beams part before them.
constexpr double kMostEntries = 8;

// Beams that advance in turns, so that none waits for what another one loads. Far sights among 10,000 segments take
// half the time that they take one by one.
constexpr std::size_t kAtOnce = 8;

}  // namespace

View::View(const Scene& scene, const Triangulation& triangulation)
    : scene_(scene),
      triangulation_(triangulation),
      coordinate_error_(scene.coordinate_error()),
      near_(kOnwardTouches * scene.touch_distance()),
      doubt_(12 * triangulation.most_uncertain() * kMostReach + 32 * kUnitRoundoff * kMostReach * kMostReach),
      most_steps_(kMostEntries * static_cast<double>(triangulation.triangles().size())),
      stretches_(64),
      beams_(64) {
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
  ViewLimit low{-receiver.tangent.x, -receiver.tangent.y, ViewLimit::kHorizon};
  const ViewLimit end{receiver.tangent.x, receiver.tangent.y, ViewLimit::kHorizon};
  stretch_count_ = beam_count_ = 0;
  for (int from = first, opened = 0; opened < count; ++opened) {
    const int to = (from + step) % count;
    const ViewLimit& high = corners[to].above ? corners[to].to : end;
    const Gate gate = corners[clockwise_ ? to : from].gate;
    if (gate == Triangulation::kShared) return false;
    Append(low, high, gate);
    if (!corners[to].above) return true;
    low = high, from = to;
  }
  return false;
}

void View::Append(const ViewLimit& low, const ViewLimit& high, Gate gate) {
  if (stretch_count_ > 0) stretches_[stretch_count_ - 1].next = static_cast<std::uint32_t>(stretch_count_);
  if (gate < Triangulation::kWall)
    beams_[beam_count_++] = {low, high, gate, static_cast<std::uint32_t>(stretch_count_)};
  stretches_[stretch_count_++] = {high.vertex, gate, kNoStretch};
}

void View::MakeRoom() {
  if (stretches_.size() < stretch_count_ + kAtOnce) stretches_.resize(2 * stretches_.size());
  if (beams_.size() < beam_count_ + kAtOnce) beams_.resize(2 * beams_.size());
}

template <bool kClockwise>
bool View::Follow(Point2 position) {
  const std::uint32_t* const triangles = triangulation_.triangles().data()->vertex;
  const Point2* const vertices = triangulation_.vertices().data();
  // Beside the opposite vertex stand the gates through the edges on its left and on its right.
  constexpr int kLow = kClockwise ? 5 : 4, kHigh = kClockwise ? 4 : 5;
  const double doubt = doubt_;
  std::size_t steps = 0;
  while (beam_count_ > 0) {
    MakeRoom();
    Beam* const beams = beams_.data();
    Stretch* const stretches = stretches_.data();
    std::size_t beam_count = beam_count_, stretch_count = stretch_count_;
    for (std::size_t k = 0; k < std::min(beam_count, kAtOnce); ++k) {
      Beam& beam = beams[k];
      const std::uint32_t* const place = triangles + beam.gate;
      const Gate to_low = place[kLow], to_high = place[kHigh];
      const std::uint32_t apex = *place;
      const double x = vertices[apex].x - position.x, y = vertices[apex].y - position.y;
      // Positive where the apex is on the inner side of a limit.
      double from_low = beam.low.x * y - beam.low.y * x, to_limit = x * beam.high.y - y * beam.high.x;
      if constexpr (kClockwise) from_low = -from_low, to_limit = -to_limit;
      ++steps;
      if (std::min(std::abs(from_low), std::abs(to_limit)) <= doubt) [[unlikely]] {
        from_low = Side(beam.low, {x, y, apex}, from_low);
        to_limit = Side(beam.high, {x, y, apex}, to_limit);
        if (from_low == 0 || to_limit == 0) return false;
      }
      // Past which side of the apex the beam goes nobody can foresee: so it is no branch.
      const Gate gate = to_low ^ ((to_low ^ to_high) & (0 - static_cast<Gate>(from_low < 0)));
      if (std::min(from_low, to_limit) > 0) {
        // The upper part is cut off.
        const ViewLimit at{x, y, apex};
        const auto added = static_cast<std::uint32_t>(stretch_count++);
        stretches[added] = {beam.high.vertex, to_high, std::exchange(stretches[beam.stretch].next, added)};
        if (to_high == Triangulation::kShared) return false;
        if (to_high < Triangulation::kWall) beams[beam_count++] = {at, beam.high, to_high, added};
        beam.high = at;
      }
      beam.gate = gate;
      if (gate < Triangulation::kWall) continue;
      if (gate == Triangulation::kShared) return false;
      stretches[beam.stretch].high = beam.high.vertex, stretches[beam.stretch].gate = gate;
      beam = beams[--beam_count];
    }
    beam_count_ = beam_count, stretch_count_ = stretch_count;
    if (static_cast<double>(steps) > most_steps_) return false;
  }
  steps_ += static_cast<double>(steps);
  return true;
}

bool View::Find(const Receiver& receiver) {
  return Open(receiver) && (clockwise_ ? Follow<true>(receiver.position) : Follow<false>(receiver.position));
}

}  // namespace flatlight
