// SPDX-License-Identifier: Apache-2.0
// The free plane between the segments of a scene, in triangles: what a point sees is found by going from triangle to
// triangle, without looking at anything that is hidden.
//
// An index as the tree is one: made once for a world, then read by any number of threads.
#ifndef FLATLIGHT_CORE_PLANE_TRIANGULATION_TRIANGULATION_H_
#define FLATLIGHT_CORE_PLANE_TRIANGULATION_TRIANGULATION_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/math/vec.h"
#include "core/plane/box.h"
#include "core/plane/triangulation/planar_cuts.h"
#include "core/scene/scene.h"

namespace flatlight {

// A way into a triangle, through one of its edges: the triangle's number times kTriangle plus the opposite vertex's
// place in it. Or, with kWall set, what stops light there: an element's number times 2, plus 1 if its front is seen;
// with kDark set too if that side does not emit.
using Gate = std::uint32_t;

class Triangulation {
 public:
  static constexpr Gate kWall = 0x80000000;
  static constexpr Gate kDark = 0x40000000;
  // Dark as far as elements go; of no element.
  static constexpr Gate kShared = 0xfffffffd;   // Several elements over one another.
  static constexpr Gate kHorizon = 0xfffffffe;  // What lies below a receiver's horizon.
  static constexpr Gate kNothing = 0xffffffff;  // The end of the plane.
  static constexpr std::uint32_t kTriangle = 8;
  static constexpr std::size_t kMostElements = 1 << 23;  // Gates have room for them, cut as often as they may be.

  static constexpr bool IsDark(Gate wall) { return (wall & kDark) != 0; }
  static constexpr std::uint32_t ElementOf(Gate wall) { return (wall & ~(kWall | kDark)) / 2; }
  static constexpr bool ShowsFront(Gate wall) { return wall % 2 != 0; }

  // Half a cache line.
  struct alignas(32) Triangle {
    std::uint32_t vertex[3];  // Counter-clockwise.
    Gate gate[5];             // Through the edges opposite the vertices; the first two once more.
  };
  static_assert(sizeof(Triangle) == kTriangle * sizeof(Gate));

  // Null if the scene has arcs, elements hardly longer than the touch distance, or so many crossings that it would not
  // pay.
  static std::shared_ptr<const Triangulation> Of(const Scene& scene);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Point2>& vertices() const { return vertices_; }
  // How far a vertex may be from where the scene has it: Scene::coordinate_error(), more at crossings and where ends
  // that touch were made one.
  double Uncertain(std::uint32_t vertex) const { return coordinate_error_ + static_cast<double>(uncertain_[vertex]); }
  // How far off a vertex elements may pass or end that go to it here: what is seen between them there is left out. 0
  // where they meet exactly.
  double Slit(std::uint32_t vertex) const { return static_cast<double>(slits_[vertex]); }
  bool has_slits() const { return has_slits_; }
  double most_uncertain() const { return most_uncertain_; }  // Of all vertices.
  // Of the scene that it was made for. It serves any scene with the same world and this error.
  double coordinate_error() const { return coordinate_error_; }
  std::size_t bytes() const;

  // The triangle that a point lies in, or at whose border it lies to rounding; kNone if it lies beyond the end of the
  // plane, or is not found.
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t Locate(const Scene& scene, Point2 p) const;

  // The gate through the edge of an element that is nearest to a point on it, into the triangle on its front's side or
  // on its back's. kNothing if other elements share that edge.
  Gate GateAt(const Scene& scene, ElementId element, Point2 on_element, bool front) const;

 private:
  // The stretch of an element along one edge, from a toward b.
  struct Piece {
    double begin;    // In lengths of the element.
    Gate into_back;  // Through it into the triangle on its back's side.
    Gate into_front;
  };

  explicit Triangulation(double coordinate_error) : coordinate_error_(coordinate_error) {}
  void TakeTriangles(const Scene& scene, const PlanarCuts& cuts);
  void ListPieces(const Scene& scene);
  void MakeHints(const Scene& scene);
  const Piece* PieceAt(const Scene& scene, std::uint32_t element, Point2 on_element) const;
  std::uint32_t Beyond(const Scene& scene, std::uint32_t triangle, int side) const;
  std::uint32_t LocateFrom(const Scene& scene, Point2 p, std::uint32_t triangle) const;
  std::size_t CellOf(double value, double low) const;

  double coordinate_error_;
  double most_uncertain_ = 0;
  std::vector<Triangle> triangles_;
  std::vector<Point2> vertices_;
  std::vector<float> uncertain_;  // What comes on top of coordinate_error_.
  std::vector<float> slits_;
  bool has_slits_ = false;
  std::vector<std::uint32_t> first_piece_;  // By element, and one more.
  std::vector<Piece> pieces_;
  // A triangle for each cell of a square grid over all vertices but the corners: to begin a search in.
  std::vector<std::uint32_t> hints_;
  std::size_t cells_a_side_ = 1;
  double cells_per_length_ = 1;
  Point2 grid_low_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_TRIANGULATION_TRIANGULATION_H_
