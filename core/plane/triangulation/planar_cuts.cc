// SPDX-License-Identifier: Apache-2.0
#include "core/plane/triangulation/planar_cuts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/math/tolerances.h"
#include "core/plane/box.h"
#include "core/plane/intersect.h"
#include "core/plane/triangulation/hilbert.h"
#include "core/plane/triangulation/predicates.h"

namespace flatlight {
namespace {

// Shorter elements, in touch distances, may vanish between vertices that are one.
constexpr double kLeastLength = 16;

// Crossings at most, by the number of elements: more would cost more than they save.
constexpr std::size_t MostVertices(std::size_t elements) { return 64 + 8 * elements; }

// Triangles looked at on the way; some 30 an element as a rule, as many as there are elements where all of them meet.
constexpr std::size_t MostWork(std::size_t elements) { return (1u << 20) + 512 * elements; }

// Numbers of this size change nothing beside the scene's, and their products would become too small for exact signs.
double WithoutTiny(double value) { return std::abs(value) < 0x1p-450 ? 0 : value; }

class Cutter {
 public:
  explicit Cutter(const Scene& scene)
      : scene_(scene),
        touch_(scene.touch_distance()),
        cuts_{Mesh(PlanarCuts::kHalf, touch_, MostWork(scene.elements().size())), {}, {}} {}

  bool Run() {
    if (scene_.traits().has_arcs || !InsertEnds()) return false;
    for (std::size_t i = 0; i < ends_.size(); i += 2) {
      pending_.push_back({ends_[i], ends_[i + 1], static_cast<std::uint32_t>(i / 2)});
      while (!pending_.empty()) {
        const Piece piece = pending_.back();
        pending_.pop_back();
        if (piece.a != piece.b && !Insert(piece)) return false;
      }
    }
    WidenSlits();
    return true;
  }

  PlanarCuts Take() { return std::move(cuts_); }

 private:
  // A stretch of an element between two vertices.
  struct Piece {
    Mesh::Vertex a;
    Mesh::Vertex b;
    std::uint32_t element;
  };

  bool InsertEnds() {
    const std::vector<Element>& elements = scene_.elements();
    Box box;
    for (const Element& element : elements) {
      if (!(element.length > kLeastLength * touch_)) return false;
      box.Add(element.a), box.Add(element.b);
    }
    std::vector<std::uint32_t> keys, order(2 * elements.size());
    for (const Element& element : elements)
      for (const Point2 end : {element.a, element.b}) keys.push_back(HilbertKey(box, end));
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t l, std::uint32_t r) { return keys[l] != keys[r] ? keys[l] < keys[r] : l < r; });
    ends_.resize(order.size());
    for (const std::uint32_t i : order) {
      const Element& element = elements[i / 2];
      const std::optional<Mesh::Vertex> v = InsertAt(i % 2 == 0 ? element.a : element.b, 0);
      if (!v || cuts_.mesh.exhausted()) return false;
      ends_[i] = *v;
    }
    return true;
  }

  // `uncertain`: of the place, if a new vertex is made there.
  std::optional<Mesh::Vertex> InsertAt(Point2 p, double uncertain, Mesh::Side near = Mesh::kNone) {
    Mesh& mesh = cuts_.mesh;
    p = {WithoutTiny(p.x), WithoutTiny(p.y)};
    const std::size_t before = mesh.points().size();
    const std::optional<Mesh::Vertex> v = mesh.Insert(p, near);
    if (!v) return std::nullopt;
    cuts_.uncertain.resize(mesh.points().size(), 0);
    cuts_.slit.resize(mesh.points().size(), 0);
    float& kept = cuts_.uncertain[*v];
    if (mesh.points().size() > before) {
      kept = static_cast<float>(uncertain);
    } else if (mesh.At(*v) != p) {
      kept = std::max(kept, static_cast<float>(touch_));
      NoteSlit(*v, Length(p - mesh.At(*v)));
    }
    return v;
  }

  bool Insert(const Piece& piece) {
    Mesh& mesh = cuts_.mesh;
    if (mesh.points().size() > MostVertices(scene_.elements().size()) || mesh.exhausted()) return false;
    const Mesh::Way way = mesh.Trace(piece.a, piece.b);
    switch (way.kind) {
      case Mesh::Way::Kind::kEdge:
        MarkEdge(way.side, piece.element);
        return true;
      case Mesh::Way::Kind::kFree: {
        const std::optional<Mesh::Side> side = mesh.Connect(piece.a, piece.b);
        if (side) mesh.SetMark(*side, piece.element);
        return side.has_value();
      }
      case Mesh::Way::Kind::kVertex:
        if (way.vertex == Mesh::kNone || !IsOn(piece.element, way.vertex)) return false;
        NoteSlit(way.vertex, piece.element);
        SplitAt(piece, way.vertex);
        return true;
      case Mesh::Way::Kind::kMarked:
        return CutBoth(piece, way.side);
    }
    return false;
  }

  // Pieces may bend to vertices close to them, over and over, but must not leave their element by that.
  bool IsOn(std::uint32_t element, Mesh::Vertex v) const {
    const Element& e = scene_.elements()[element];
    return std::abs(Cross(e.b - e.a, cuts_.mesh.At(v) - e.a)) <= 3 * touch_ * e.length;
  }

  void NoteSlit(Mesh::Vertex v, double wide) {
    cuts_.slit[v] = std::max(cuts_.slit[v], static_cast<float>(wide * (1 + 0x1p-22)));
  }
  // Where an element bends to a vertex that it passes.
  void NoteSlit(Mesh::Vertex v, std::uint32_t element) {
    const Element& e = scene_.elements()[element];
    const Point2 place = cuts_.mesh.At(v);
    if (Orientation(e.a, e.b, place) == 0) return;
    NoteSlit(v, std::abs(Cross(e.b - e.a, place - e.a)) / e.length + 12 * kUnitRoundoff);
  }

  // Two ways that leave a vertex at an angle, each beginning so far off it, may cross that much farther on by the sine
  // of the angle; if it is obtuse, no farther than they are apart.
  void WidenSlits() {
    if (std::all_of(cuts_.slit.begin(), cuts_.slit.end(), [](float slit) { return slit == 0; })) return;
    const Mesh& mesh = cuts_.mesh;
    struct Way {
      Mesh::Vertex from;
      double angle;  // Grows with it, around once from -2 to 2.
      Vector2 direction;
      double length;
    };
    std::vector<Way> ways;
    for (Mesh::Side side = 0; side < 3 * mesh.triangles(); ++side) {
      const Mesh::Vertex from = mesh.From(side);
      if (mesh.Mark(side) == Mesh::kNone || cuts_.slit[from] == 0) continue;
      const Vector2 way = mesh.At(mesh.To(side)) - mesh.At(from), direction = Normalized(way);
      const double right = direction.x / (std::abs(direction.x) + std::abs(direction.y));
      ways.push_back({from, std::copysign(1 - right, direction.y), direction, Length(way)});
    }
    std::sort(ways.begin(), ways.end(),
              [](const Way& l, const Way& r) { return l.from != r.from ? l.from < r.from : l.angle < r.angle; });
    for (std::size_t begin = 0, end = 0; begin < ways.size(); begin = end) {
      while (end < ways.size() && ways[end].from == ways[begin].from) ++end;
      double widest = 1, longest = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const Way& next = ways[i + 1 < end ? i + 1 : begin];
        longest = std::max(longest, ways[i].length);
        if (end - begin > 1 && Dot(ways[i].direction, next.direction) > 0)
          widest = std::max(widest, 1 / std::abs(Cross(ways[i].direction, next.direction)));
      }
      const double slit = static_cast<double>(cuts_.slit[ways[begin].from]);
      NoteSlit(ways[begin].from, std::min(slit * widest, std::max(slit, longest)));
    }
  }

  void MarkEdge(Mesh::Side side, std::uint32_t element) {
    const std::uint32_t mark = cuts_.mesh.Mark(side);
    cuts_.mesh.SetMark(side, mark == Mesh::kNone || mark == element ? element : PlanarCuts::kShared);
  }

  void SplitAt(const Piece& piece, Mesh::Vertex v) {
    pending_.push_back({piece.a, v, piece.element});
    pending_.push_back({v, piece.b, piece.element});
  }

  // Cuts a piece and the marked edge that crosses it.
  bool CutBoth(const Piece& piece, Mesh::Side side) {
    Mesh& mesh = cuts_.mesh;
    const Piece other{mesh.From(side), mesh.To(side), mesh.Mark(side)};
    if (other.element == PlanarCuts::kShared) return false;
    double uncertain = 0;
    const Point2 place = Crossing(piece, other, uncertain);
    const std::size_t before = mesh.points().size();
    const std::optional<Mesh::Vertex> v = InsertAt(place, uncertain, side);
    if (!v) return false;
    if (mesh.points().size() == before) NoteSlit(*v, piece.element), NoteSlit(*v, other.element);
    if (*v == other.a || *v == other.b) {
      // The piece passes an end of the other one. It must get ahead.
      if (*v == piece.a || *v == piece.b) return false;
      SplitAt(piece, *v);
      return true;
    }
    // Its side may have another number by now; the insertion may have cut it too.
    const Mesh::Way way = mesh.Trace(other.a, other.b);
    if (way.kind == Mesh::Way::Kind::kEdge) mesh.SetMark(way.side, Mesh::kNone);
    SplitAt(other, *v);
    SplitAt(piece, *v);
    return true;
  }

  Point2 Crossing(const Piece& piece, const Piece& other, double& uncertain) const {
    // Of the elements themselves, as for all who ask for their crossing.
    const std::uint32_t first = std::min(piece.element, other.element), second = std::max(piece.element, other.element);
    const Element& e = scene_.elements()[first];
    const Element& f = scene_.elements()[second];
    const Vector2 along = e.b - e.a, beside = f.b - f.a;
    const double sine = std::abs(Cross(along, beside)) / (e.length * f.length);
    // Along either of them it moves by what the other is off, over the sine of the angle.
    uncertain = std::min(1.0, 2 * scene_.coordinate_error() / sine);
    const ElementCrossings points = CrossElements(e, f, touch_);
    if (points.count == 1) return points.point[0];
    // Not of their own lines, then, but of what ends that are one made of them.
    const Point2 a = cuts_.mesh.At(piece.a), c = cuts_.mesh.At(other.a);
    const Vector2 way = cuts_.mesh.At(piece.b) - a, across = cuts_.mesh.At(other.b) - c;
    const double t = Cross(c - a, across) / Cross(way, across);
    return a + std::clamp(t, 0.0, 1.0) * way;
  }

  const Scene& scene_;
  const double touch_;
  PlanarCuts cuts_;
  std::vector<Mesh::Vertex> ends_;  // By element, of a and b.
  std::vector<Piece> pending_;
};

}  // namespace

std::optional<PlanarCuts> CutSegments(const Scene& scene) {
  Cutter cutter(scene);
  if (!cutter.Run()) return std::nullopt;
  return cutter.Take();
}

}  // namespace flatlight
