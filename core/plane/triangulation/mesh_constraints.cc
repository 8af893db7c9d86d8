// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>

#include "core/plane/triangulation/mesh.h"
#include "core/plane/triangulation/predicates.h"

namespace flatlight {

bool Mesh::IsNear(Vertex a, Vertex b, Vertex v) const {
  const Vector2 along = At(b) - At(a), to = At(v) - At(a);
  const double length = Length(along), progress = Dot(along, to);
  if (!(progress > 0 && progress < length * length)) return false;
  return std::abs(Cross(along, to)) <= weld_ * length || Orientation(At(a), At(b), At(v)) == 0;
}

Mesh::Way Mesh::Trace(Vertex a, Vertex b) {
  using Kind = Way::Kind;
  crossed_.clear();
  const Point2 pa = At(a), pb = At(b);
  // Around a: the edge to b, a vertex on the way, or the side that the way leaves by.
  Side out = kNone;
  const Side start = at_[a];
  Side s = start;
  do {
    ++work_;
    if (From(s) == b) return {Kind::kEdge, Previous(s), kNone};
    if (To(s) == b) return {Kind::kEdge, Next(s), kNone};
    s = Next(twin_[Next(s)]);
  } while (s != start);
  do {
    if (IsNear(a, b, From(s))) return {Kind::kVertex, kNone, From(s)};
    if (Orientation(pa, pb, At(From(s))) < 0 && Orientation(pa, pb, At(To(s))) > 0) out = s;
    s = Next(twin_[Next(s)]);
  } while (s != start);
  while (out != kNone) {
    ++work_;
    if (mark_[out] != kNone) return {Kind::kMarked, out, kNone};
    crossed_.push_back({From(out), To(out)});
    const Side in = twin_[out];
    const Vertex apex = vertex_[in];
    if (apex == b) return {Kind::kFree, kNone, kNone};
    if (IsNear(a, b, apex)) return {Kind::kVertex, kNone, apex};
    // The way leaves between the apex and the end that lies on the other side of it.
    out = Orientation(pa, pb, At(apex)) < 0 ? Previous(in) : Next(in);
  }
  return {Kind::kVertex, kNone, kNone};
}

bool Mesh::IsConvex(Side s) const {
  const Point2 a = At(vertex_[s]), b = At(vertex_[twin_[s]]), from = At(From(s)), to = At(To(s));
  return Orientation(a, from, b) > 0 && Orientation(b, to, a) > 0;
}

std::optional<Mesh::Side> Mesh::Connect(Vertex a, Vertex b) {
  const Point2 pa = At(a), pb = At(b);
  made_.clear();
  const std::size_t most = 64 + 8 * crossed_.size() * crossed_.size();
  std::size_t steps = 0;
  for (std::size_t first = 0; first < crossed_.size(); ++first) {
    if (++steps > most || exhausted()) return std::nullopt;
    const Ends edge = crossed_[first];
    const Side s = FindEdge(edge.from, edge.to);
    if (!IsConvex(s)) {
      crossed_.push_back(edge);
      continue;
    }
    const Vertex from = vertex_[s], to = vertex_[twin_[s]];
    Flip(s);
    const bool at_end = from == a || from == b || to == a || to == b;
    if (!at_end && Orientation(pa, pb, At(from)) != Orientation(pa, pb, At(to))) {
      crossed_.push_back({from, to});
    } else {
      made_.push_back({from, to});
    }
  }
  const Side connection = FindEdge(a, b);
  if (connection == kNone) return std::nullopt;
  SetMark(connection, 0);  // So that it stays.
  for (const Ends& edge : made_) {
    const Side s = FindEdge(edge.from, edge.to);
    if (s != kNone) pending_.push_back(s);
    Legalize();
  }
  return FindEdge(a, b);
}

}  // namespace flatlight
