// SPDX-License-Identifier: Apache-2.0
// A constrained Delaunay triangulation of a square, made point by point and edge by edge.
//
// Every decision that the mesh's being a triangulation rests on is exact: whatever the input, triangles turn
// counter-clockwise, and cover the square once. Lawson 1977 (flips), Sloan 1993 (constraints by flips,
// doi:10.1016/0045-7949(93)90239-A).
#ifndef FLATLIGHT_CORE_PLANE_TRIANGULATION_MESH_H_
#define FLATLIGHT_CORE_PLANE_TRIANGULATION_MESH_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/vec.h"

namespace flatlight {

class Mesh {
 public:
  // Triangle t has the sides 3 t, 3 t + 1, 3 t + 2: a side is the edge opposite a vertex, with the triangle on its
  // left.
  using Side = std::uint32_t;
  using Vertex = std::uint32_t;
  static constexpr std::uint32_t kNone = 0xffffffff;

  static constexpr Side Next(Side s) { return s % 3 == 2 ? s - 2 : s + 1; }
  static constexpr Side Previous(Side s) { return s % 3 == 0 ? s + 2 : s - 1; }

  // The square [-half, half]^2, its corners the vertices 0 to 3, in two triangles. Points closer than `weld` are one.
  // `most_work`: see exhausted().
  Mesh(double half, double weld, std::size_t most_work = SIZE_MAX);

  std::size_t triangles() const { return vertex_.size() / 3; }
  const std::vector<Point2>& points() const { return points_; }
  Vertex Opposite(Side s) const { return vertex_[s]; }
  Vertex From(Side s) const { return vertex_[Next(s)]; }
  Vertex To(Side s) const { return vertex_[Previous(s)]; }
  Point2 At(Vertex v) const { return points_[v]; }
  // The same edge, of the triangle on the other side; kNone at the square's border.
  Side Twin(Side s) const { return twin_[s]; }
  // What the edge was marked with; kNone if it is free.
  std::uint32_t Mark(Side s) const { return mark_[s]; }

  // The vertex at a point strictly inside the square: one that was there within `weld`, or a new one. Absent if the
  // point is not found, which only a mesh of needles can bring about. The search begins at `near`, or where the last
  // point was found.
  std::optional<Vertex> Insert(Point2 p, Side near = kNone);

  // What lies between two vertices.
  struct Way {
    enum class Kind : std::uint8_t { kEdge, kFree, kVertex, kMarked };
    Kind kind = Kind::kEdge;
    Side side = kNone;      // kEdge: that edge. kMarked: the first marked edge that crosses the way.
    Vertex vertex = kNone;  // kVertex: a vertex on the way, to within the distance `weld`.
  };
  // kFree: the edges that cross it are in `crossed`, by their ends.
  Way Trace(Vertex a, Vertex b);
  // Makes the edge between two vertices whose way is kFree, right after Trace. Absent if that takes more than
  // most_work.
  std::optional<Side> Connect(Vertex a, Vertex b);

  void SetMark(Side s, std::uint32_t mark);

  // Whether more triangles were looked at than most_work, as where very many edges meet in one vertex: time to stop.
  bool exhausted() const { return work_ > most_work_; }

 private:
  struct Ends {
    Vertex from;
    Vertex to;
  };

  std::optional<Side> Locate(Point2 p);
  // Replaces triangles around a point by such that have it as a vertex; `outer` are the sides they keep, in turn.
  void Fan(Vertex p, const Side* outer, const std::uint32_t* triangles, int count);
  void SetTriangle(std::uint32_t t, Vertex a, Vertex b, Vertex c);
  void Link(Side s, Side twin);
  void Flip(Side s);
  // Flips what is not Delaunay among the sides in pending_, and what that leads to.
  void Legalize();
  bool IsConvex(Side s) const;
  bool IsNear(Vertex a, Vertex b, Vertex v) const;
  Side FindEdge(Vertex from, Vertex to);

  const double weld_;
  const std::size_t most_work_;
  std::vector<Point2> points_;
  std::vector<Side> at_;  // By vertex: a side that it is opposite to.
  std::vector<Vertex> vertex_;
  std::vector<Side> twin_;
  std::vector<std::uint32_t> mark_;
  Side last_ = 0;  // Where the last point was found.
  std::uint32_t turn_ = 0;
  std::size_t work_ = 0;
  std::vector<Side> pending_;
  std::vector<Ends> crossed_;
  std::vector<Ends> made_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_TRIANGULATION_MESH_H_
