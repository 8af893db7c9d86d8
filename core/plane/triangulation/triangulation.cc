// SPDX-License-Identifier: Apache-2.0
#include "core/plane/triangulation/triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/plane/triangulation/hilbert.h"

namespace flatlight {
namespace {

// Walks are short; one that is not has lost its way among needles.
constexpr int kMostSteps = 4096;

Point2 Middle(Point2 a, Point2 b) { return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}; }

// In lengths of the element, from a.
double Along(const Element& element, Point2 p) {
  const Vector2 along = element.b - element.a;
  return Dot(p - element.a, along) / LengthSquared(along);
}

Box BoxOf(const Scene& scene) {
  Box box;
  for (const Element& element : scene.elements()) box.Add(element.a), box.Add(element.b);
  return box;
}

// Triangles in the order in which they lie along a curve that fills the plane, so that what is seen together is near in
// memory.
std::vector<std::uint32_t> SpatialOrder(const Mesh& mesh, const Box& box) {
  std::vector<std::uint64_t> keyed(mesh.triangles());
  for (std::uint32_t t = 0; t < keyed.size(); ++t) {
    const Point2 a = mesh.At(mesh.Opposite(3 * t)), b = mesh.At(mesh.Opposite(3 * t + 1));
    const Point2 c = mesh.At(mesh.Opposite(3 * t + 2));
    keyed[t] = std::uint64_t{HilbertKey(box, Middle(Middle(a, b), Middle(b, c)))} << 32 | t;
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::uint32_t> order(keyed.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) order[i] = static_cast<std::uint32_t>(keyed[i]);
  return order;
}

}  // namespace

std::shared_ptr<const Triangulation> Triangulation::Of(const Scene& scene) {
  if (scene.elements().empty() || scene.elements().size() > kMostElements) return nullptr;
  const std::optional<PlanarCuts> cuts = CutSegments(scene);
  if (!cuts) return nullptr;
  std::shared_ptr<Triangulation> made(new Triangulation(scene.coordinate_error()));
  made->TakeTriangles(scene, *cuts);
  made->ListPieces(scene);
  made->MakeHints(scene);
  return made;
}

std::size_t Triangulation::bytes() const {
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  return sizeof(*this) + bytes(triangles_) + bytes(vertices_) + bytes(uncertain_) + bytes(slits_) +
         bytes(first_piece_) + bytes(pieces_) + bytes(hints_);
}

void Triangulation::TakeTriangles(const Scene& scene, const PlanarCuts& cuts) {
  const Mesh& mesh = cuts.mesh;
  const std::vector<std::uint32_t> order = SpatialOrder(mesh, BoxOf(scene));
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  std::vector<std::uint32_t> number(mesh.points().size(), kNone);
  vertices_.reserve(number.size()), uncertain_.reserve(number.size()), slits_.reserve(number.size());
  const auto number_of = [&](Mesh::Vertex v) {
    if (number[v] == kNone) {
      number[v] = static_cast<std::uint32_t>(vertices_.size());
      vertices_.push_back(mesh.At(v));
      uncertain_.push_back(cuts.uncertain[v]);
      slits_.push_back(cuts.slit[v]);
      has_slits_ = has_slits_ || cuts.slit[v] > 0;
    }
    return number[v];
  };
  const auto gate_of = [&](Mesh::Side side) -> Gate {
    if (const std::uint32_t mark = mesh.Mark(side); mark == PlanarCuts::kShared) {
      return kShared;
    } else if (mark != Mesh::kNone) {
      const Element& element = scene.elements()[mark];
      const bool along = Dot(mesh.At(mesh.To(side)) - mesh.At(mesh.From(side)), element.b - element.a) > 0;
      const Curve& curve = scene.curve(element.curve);
      const bool dark = curve.EmittedRadiance(along ? Side::kFront : Side::kBack).IsBlack();
      return kWall | (dark ? kDark : 0) | (2 * mark + (along ? 1 : 0));
    }
    const Mesh::Side twin = mesh.Twin(side);
    return twin == Mesh::kNone ? kNothing : kTriangle * place[twin / 3] + twin % 3;
  };
  most_uncertain_ = coordinate_error_;
  for (const float extra : cuts.uncertain)
    most_uncertain_ = std::max(most_uncertain_, coordinate_error_ + static_cast<double>(extra));
  triangles_.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    Triangle& triangle = triangles_[i];
    for (std::uint32_t k = 0; k < 3; ++k) {
      triangle.vertex[k] = number_of(mesh.Opposite(3 * order[i] + k));
      triangle.gate[k] = gate_of(3 * order[i] + k);
    }
    triangle.gate[3] = triangle.gate[0], triangle.gate[4] = triangle.gate[1];
  }
}

void Triangulation::ListPieces(const Scene& scene) {
  const std::size_t elements = scene.elements().size();
  struct Half {
    std::uint32_t element;
    double begin;
    Gate gate;
    bool front;
  };
  std::vector<Half> halves;
  first_piece_.assign(elements + 1, 0);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& triangle = triangles_[t];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Gate gate = triangle.gate[k];
      if (gate < kWall || gate >= kShared) continue;
      const std::uint32_t element = ElementOf(gate);
      const bool front = ShowsFront(gate);
      // Of the edge's two ends, that toward a.
      const std::uint32_t first = triangle.vertex[(k + (front ? 1 : 2)) % 3];
      halves.push_back({element, Along(scene.elements()[element], vertices_[first]), kTriangle * t + k, front});
      ++first_piece_[element + 1];
    }
  }
  std::sort(halves.begin(), halves.end(), [](const Half& l, const Half& r) {
    return l.element != r.element ? l.element < r.element : l.begin != r.begin ? l.begin < r.begin : l.front < r.front;
  });
  // Each edge has two sides.
  for (std::size_t e = 0; e < elements; ++e) first_piece_[e + 1] = first_piece_[e] + first_piece_[e + 1] / 2;
  pieces_.reserve(halves.size() / 2);
  for (std::size_t i = 0; i + 1 < halves.size(); i += 2)
    pieces_.push_back({halves[i].begin, halves[i].gate, halves[i + 1].gate});
}

const Triangulation::Piece* Triangulation::PieceAt(const Scene& scene, std::uint32_t element, Point2 on_element) const {
  const auto first = pieces_.begin() + first_piece_[element], last = pieces_.begin() + first_piece_[element + 1];
  if (first == last) return nullptr;
  if (last - first == 1) return &*first;
  const double along = Along(scene.elements()[element], on_element);
  const auto next =
      std::upper_bound(first + 1, last, along, [](double value, const Piece& piece) { return value < piece.begin; });
  return &*(next - 1);
}

Gate Triangulation::GateAt(const Scene& scene, ElementId element, Point2 on_element, bool front) const {
  const Piece* piece = PieceAt(scene, static_cast<std::uint32_t>(element), on_element);
  if (!piece) return kNothing;
  return front ? piece->into_front : piece->into_back;
}

std::uint32_t Triangulation::Beyond(const Scene& scene, std::uint32_t triangle, int side) const {
  const Gate gate = triangles_[triangle].gate[side];
  if (gate < kWall) return gate / kTriangle;
  if (gate >= kShared) return kNone;
  const std::uint32_t* vertex = triangles_[triangle].vertex;
  const Point2 middle = Middle(vertices_[vertex[(side + 1) % 3]], vertices_[vertex[(side + 2) % 3]]);
  const Piece* piece = PieceAt(scene, ElementOf(gate), middle);
  return piece ? (ShowsFront(gate) ? piece->into_back : piece->into_front) / kTriangle : kNone;
}

std::uint32_t Triangulation::LocateFrom(const Scene& scene, Point2 p, std::uint32_t triangle) const {
  for (int step = 0; step < kMostSteps; ++step) {
    const std::uint32_t* vertex = triangles_[triangle].vertex;
    const Vector2 to[3] = {vertices_[vertex[0]] - p, vertices_[vertex[1]] - p, vertices_[vertex[2]] - p};
    int outside = -1;
    // From another side each time, so that no walk goes round in circles.
    for (int i = 0; i < 3; ++i) {
      const int side = (i + step) % 3;
      if (Cross(to[(side + 1) % 3], to[(side + 2) % 3]) < 0) {
        outside = side;
        break;
      }
    }
    if (outside < 0) return triangle;
    triangle = Beyond(scene, triangle, outside);
    if (triangle == kNone) return kNone;
  }
  return kNone;
}

std::size_t Triangulation::CellOf(double value, double low) const {
  const double cell = (value - low) * cells_per_length_;
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(cells_a_side_ - 1)));
}

std::uint32_t Triangulation::Locate(const Scene& scene, Point2 p) const {
  if (!(std::max(std::abs(p.x), std::abs(p.y)) < PlanarCuts::kHalf)) return kNone;
  return LocateFrom(scene, p, hints_[CellOf(p.y, grid_low_.y) * cells_a_side_ + CellOf(p.x, grid_low_.x)]);
}

void Triangulation::MakeHints(const Scene& scene) {
  const Box box = BoxOf(scene);
  cells_a_side_ = static_cast<std::size_t>(std::max(1.0, std::sqrt(static_cast<double>(triangles_.size()))));
  const double side = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  cells_per_length_ = static_cast<double>(cells_a_side_) / side;
  grid_low_ = box.low;
  hints_.assign(cells_a_side_ * cells_a_side_, 0);
  std::uint32_t near = 0;
  for (std::size_t row = 0; row < cells_a_side_; ++row) {
    for (std::size_t i = 0; i < cells_a_side_; ++i) {
      // There and back again, so that each cell is beside the one before.
      const std::size_t column = row % 2 == 0 ? i : cells_a_side_ - 1 - i;
      const Point2 middle{box.low.x + (static_cast<double>(column) + 0.5) / cells_per_length_,
                          box.low.y + (static_cast<double>(row) + 0.5) / cells_per_length_};
      const std::uint32_t found = LocateFrom(scene, middle, near);
      if (found != kNone) near = found;
      hints_[row * cells_a_side_ + column] = near;
    }
  }
}

}  // namespace flatlight
