// SPDX-License-Identifier: Apache-2.0
#include "core/plane/triangulation/mesh.h"

#include "core/plane/triangulation/predicates.h"

namespace flatlight {

Mesh::Mesh(double half, double weld, std::size_t most_work) : weld_(weld), most_work_(most_work) {
  points_ = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  at_.assign(4, kNone);
  vertex_.resize(6), twin_.assign(6, kNone), mark_.assign(6, kNone);
  SetTriangle(0, 0, 1, 2);
  SetTriangle(1, 0, 2, 3);
  Link(1, 5);  // From 2 to 0, and from 0 to 2.
}

void Mesh::SetTriangle(std::uint32_t t, Vertex a, Vertex b, Vertex c) {
  const Side s = 3 * t;
  vertex_[s] = a, vertex_[s + 1] = b, vertex_[s + 2] = c;
  at_[a] = s, at_[b] = s + 1, at_[c] = s + 2;
}

void Mesh::Link(Side s, Side twin) {
  twin_[s] = twin;
  if (twin != kNone) twin_[twin] = s;
}

void Mesh::SetMark(Side s, std::uint32_t mark) {
  mark_[s] = mark;
  if (twin_[s] != kNone) mark_[twin_[s]] = mark;
}

std::optional<Mesh::Side> Mesh::Locate(Point2 p) {
  std::uint32_t t = last_ / 3;
  for (std::size_t steps = 0; steps < 3 * triangles(); ++steps) {
    ++work_;
    Side outside = kNone;
    // From another side each time, so that no walk goes round in circles for ever.
    for (std::uint32_t i = 0; i < 3 && outside == kNone; ++i) {
      const Side s = 3 * t + (i + (turn_ >> 16)) % 3;
      if (Orientation(At(From(s)), At(To(s)), p) < 0) outside = s;
    }
    turn_ = turn_ * 1664525 + 1013904223;  // A linear congruence; its upper bits count.
    if (outside == kNone) return last_ = 3 * t;
    if (twin_[outside] == kNone) return std::nullopt;
    t = twin_[outside] / 3;
  }
  return std::nullopt;
}

std::optional<Mesh::Vertex> Mesh::Insert(Point2 p, Side near) {
  if (near != kNone) last_ = near;
  const std::optional<Side> found = Locate(p);
  if (!found) return std::nullopt;
  const std::uint32_t t = *found / 3;
  for (Side s = 3 * t; s < 3 * t + 3; ++s) {
    if (LengthSquared(p - At(vertex_[s])) <= weld_ * weld_) return vertex_[s];
  }
  const auto v = static_cast<Vertex>(points_.size());
  points_.push_back(p);
  at_.push_back(kNone);
  Side on = kNone;
  for (Side s = 3 * t; s < 3 * t + 3; ++s)
    if (Orientation(At(From(s)), At(To(s)), p) == 0) on = s;
  const auto fresh = static_cast<std::uint32_t>(triangles());
  const std::size_t sides = vertex_.size() + 6;
  vertex_.resize(sides, kNone), twin_.resize(sides, kNone), mark_.resize(sides, kNone);
  if (on == kNone) {
    const Side outer[] = {3 * t, 3 * t + 1, 3 * t + 2};
    const std::uint32_t made[] = {t, fresh, fresh + 1};
    Fan(v, outer, made, 3);
  } else {
    const Side twin = twin_[on];
    const std::uint32_t mark = mark_[on];
    const Side outer[] = {Next(on), Previous(on), Next(twin), Previous(twin)};
    const std::uint32_t made[] = {t, fresh, twin / 3, fresh + 1};
    const Vertex from = From(on), to = To(on);
    Fan(v, outer, made, 4);
    if (mark != kNone) {
      SetMark(FindEdge(v, from), mark);
      SetMark(FindEdge(v, to), mark);
    }
  }
  Legalize();
  return v;
}

void Mesh::Fan(Vertex p, const Side* outer, const std::uint32_t* triangles, int count) {
  struct Kept {
    Vertex from;
    Vertex to;
    Side twin;
    std::uint32_t mark;
  } kept[4];
  for (int k = 0; k < count; ++k) kept[k] = {From(outer[k]), To(outer[k]), twin_[outer[k]], mark_[outer[k]]};
  for (int k = 0; k < count; ++k) {
    SetTriangle(triangles[k], p, kept[k].from, kept[k].to);
    const Side s = 3 * triangles[k];
    mark_[s] = kept[k].mark, mark_[s + 1] = mark_[s + 2] = kNone;
    Link(s, kept[k].twin);
    pending_.push_back(s);
  }
  // From the end of each outer side to p, and back.
  for (int k = 0; k < count; ++k) Link(3 * triangles[k] + 1, 3 * triangles[(k + 1) % count] + 2);
}

void Mesh::Flip(Side s) {
  const Side g = twin_[s];
  const std::uint32_t t = s / 3, u = g / 3;
  const Vertex a = vertex_[s], b = vertex_[g], from = From(s), to = To(s);
  const Side outer[] = {Next(s), Previous(s), Next(g), Previous(g)};
  Side twins[4];
  std::uint32_t marks[4];
  for (int i = 0; i < 4; ++i) twins[i] = twin_[outer[i]], marks[i] = mark_[outer[i]];
  // Of t: the sides opposite a, from, b. Of u: opposite b, to, a.
  SetTriangle(t, a, from, b);
  SetTriangle(u, b, to, a);
  const Side places[] = {3 * u, 3 * t + 2, 3 * t, 3 * u + 2};
  for (int i = 0; i < 4; ++i) {
    Link(places[i], twins[i]);
    mark_[places[i]] = marks[i];
  }
  Link(3 * t + 1, 3 * u + 1);
  mark_[3 * t + 1] = mark_[3 * u + 1] = kNone;
}

void Mesh::Legalize() {
  while (!pending_.empty()) {
    ++work_;
    const Side s = pending_.back();
    pending_.pop_back();
    const Side g = twin_[s];
    if (g == kNone || mark_[s] != kNone) continue;
    if (!IsInsideCircle(At(vertex_[s]), At(From(s)), At(To(s)), At(vertex_[g]))) continue;
    const std::uint32_t t = s / 3, u = g / 3;
    Flip(s);
    for (const Side outer : {3 * t, 3 * t + 2, 3 * u, 3 * u + 2}) pending_.push_back(outer);
  }
}

Mesh::Side Mesh::FindEdge(Vertex from, Vertex to) {
  // Around `from` counter-clockwise, then, if that ended at the border, the other way.
  const Side start = at_[from];
  Side s = start;
  do {
    ++work_;
    if (From(s) == to) return Previous(s);
    if (To(s) == to) return Next(s);
    const Side across = twin_[Next(s)];
    if (across == kNone) break;
    s = Next(across);
  } while (s != start);
  for (s = start; twin_[Previous(s)] != kNone;) {
    ++work_;
    s = Previous(twin_[Previous(s)]);
    if (s == start) break;
    if (From(s) == to) return Previous(s);
  }
  return kNone;
}

}  // namespace flatlight
