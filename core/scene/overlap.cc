// SPDX-License-Identifier: Apache-2.0
#include "core/scene/overlap.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// A stretch of an element, in fractions of its length.
struct Stretch {
  double from = 0;
  double to = 1;
};

// A piece in a cell of lines or circles that may be the same, with its interval on the line.
struct Entry {
  std::uint64_t cell = 0;
  double low = 0;
  double high = 0;
  std::uint32_t piece = 0;
};

// Three coordinates of the line or circle, and the interval of the piece on it.
struct Carrier {
  double coordinate[3];
  double low = 0;
  double high = 0;
};

Carrier CarrierOf(const Element& element) {
  // Arcs of one circle are few: all are compared.
  if (element.kind == Element::Kind::kArc) return {{element.center.x, element.center.y, 3 + element.radius}, 0, 1};
  const Vector2 along = element.b - element.a;
  Vector2 direction = Normalized(along);
  // One of the two directions of the line: which one flips only at right angles to a direction that nobody uses.
  if (Dot(direction, {0.8371, 0.5470}) < 0) direction = -direction;
  const double s = Dot(direction, element.a - Point2{});
  const double t = Dot(direction, element.b - Point2{});
  return {{direction.x * direction.x - direction.y * direction.y, 2 * direction.x * direction.y,
           std::abs(Cross(direction, element.a - Point2{}))},
          std::min(s, t),
          std::max(s, t)};
}

// Cells are far larger than the differences between coordinates of one carrier. A piece is entered in every cell within
// a quarter of a cell, so that two pieces on one carrier share at least one.
void AddEntries(const Element& element, std::uint32_t index, std::vector<Entry>& entries) {
  constexpr double kCellsPerUnit = 0x1p28;
  const Carrier carrier = CarrierOf(element);
  std::uint64_t cells[8];
  std::size_t count = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::uint64_t hash = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double shift = (corner >> axis & 1) != 0 ? 0.25 : -0.25;
      const double cell = std::floor(std::clamp(carrier.coordinate[axis], -1e9, 1e9) * kCellsPerUnit + shift);
      hash = (hash ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(cell))) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    if (std::find(cells, cells + count, hash) == cells + count) cells[count++] = hash;
  }
  for (std::size_t i = 0; i < count; ++i) entries.push_back({cells[i], carrier.low, carrier.high, index});
}

// Where `other` covers `element`, if it does.
bool Covered(const Element& element, const Element& other, double near, Stretch& stretch) {
  if (element.kind != other.kind) return false;
  const Vector2 chord = element.b - element.a;
  const double length = Length(chord);
  if (element.kind == Element::Kind::kSegment) {
    double side_s = Cross(chord, other.a - element.a) / length;
    double side_t = Cross(chord, other.b - element.a) / length;
    double s = Dot(other.a - element.a, chord) / length;
    double t = Dot(other.b - element.a, chord) / length;
    if (s > t) std::swap(s, t), std::swap(side_s, side_t);
    const double from = std::max(s, 0.0), to = std::min(t, length);
    if (!(to - from > near)) return false;
    // Distance between the lines at both ends of the common stretch.
    const auto side_at = [&](double x) { return side_s + (side_t - side_s) * (x - s) / (t - s); };
    if (std::abs(side_at(from)) > near || std::abs(side_at(to)) > near) return false;
    stretch = {from / length, to / length};
    return true;
  }
  if (std::abs(element.center.x - other.center.x) > near || std::abs(element.center.y - other.center.y) > near ||
      std::abs(element.radius - other.radius) > near) {
    return false;
  }
  // Angles of the other's ends from element.a, in the sense of the element; both turn by at most a quarter.
  const double sense = element.Orientation();
  const auto angle = [&](Vector2 radial) {
    return std::atan2(sense * Cross(element.radial_a, radial), Dot(element.radial_a, radial));
  };
  double s = angle(other.radial_a), t = angle(other.radial_b);
  if (s > t) std::swap(s, t);
  if (t - s > 2) return false;  // It lies around the opposite point.
  const double sweep = std::abs(element.sweep_angle);
  const double from = std::max(s, 0.0), to = std::min(t, sweep);
  if (!((to - from) * element.radius > near)) return false;
  stretch = {from / sweep, to / sweep};
  return true;
}

Element Cut(const Element& element, Stretch stretch) {
  Element cut = element;
  if (stretch.from > 0) {
    cut.a = FrameAt(element, stretch.from).position;
    cut.arc_begin = element.arc_begin + stretch.from * element.length;
  }
  if (stretch.to < 1) cut.b = FrameAt(element, stretch.to).position;
  cut.sweep_angle = (stretch.to - stretch.from) * element.sweep_angle;
  cut.length = (stretch.to - stretch.from) * element.length;
  if (element.kind == Element::Kind::kArc) {
    if (stretch.from > 0) cut.radial_a = -element.Orientation() * FrontNormal(element, cut.a);
    if (stretch.to < 1) cut.radial_b = -element.Orientation() * FrontNormal(element, cut.b);
  }
  return cut;
}

// What the pieces listed before it cover of each piece.
std::unordered_map<std::uint32_t, std::vector<Stretch>> FindOverlaps(const std::vector<Element>& pieces, double near) {
  std::vector<Entry> entries;
  entries.reserve(pieces.size() + pieces.size() / 4);
  for (std::uint32_t i = 0; i < pieces.size(); ++i) AddEntries(pieces[i], i, entries);
  std::sort(entries.begin(), entries.end(), [](const Entry& l, const Entry& r) {
    return l.cell != r.cell ? l.cell < r.cell : l.low != r.low ? l.low < r.low : l.piece < r.piece;
  });
  std::unordered_map<std::uint32_t, std::vector<Stretch>> covered;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = i + 1; j < entries.size(); ++j) {
      if (entries[j].cell != entries[i].cell || entries[j].low > entries[i].high) break;
      const auto [first, second] = std::minmax(entries[i].piece, entries[j].piece);
      if (Stretch stretch; Covered(pieces[second], pieces[first], near, stretch)) covered[second].push_back(stretch);
    }
  }
  return covered;
}

}  // namespace

std::vector<Element> RemoveOverlaps(const std::vector<Element>& pieces, double near) {
  auto covered = FindOverlaps(pieces, near);
  if (covered.empty()) return pieces;
  std::vector<Element> kept;
  kept.reserve(pieces.size());
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    const Element& piece = pieces[i];
    const auto found = covered.find(i);
    if (found == covered.end()) {
      kept.push_back(piece);
      continue;
    }
    std::vector<Stretch>& stretches = found->second;
    std::sort(stretches.begin(), stretches.end(), [](Stretch l, Stretch r) { return l.from < r.from; });
    stretches.push_back({1, 1});
    const double least = near / piece.length;
    double at = 0;
    for (const Stretch& stretch : stretches) {
      if (stretch.from - at > least) kept.push_back(Cut(piece, {at, stretch.from}));
      at = std::max(at, stretch.to);
    }
  }
  return kept;
}

}  // namespace flatlight
