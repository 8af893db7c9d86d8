// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/envelope.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/math/tolerances.h"
#include "core/plane/exact/meeting.h"
#include "core/plane/intersect.h"

namespace flatlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Far above rounding, far below what would cost time.
constexpr double kKeyMargin = 1e-10;
constexpr float kBeyond = 4;  // A key that nothing reaches.

// Sine of a small angle.
constexpr double kShallow = 0.1;

// Distances that differ by more than so many bounds on their errors differ for certain.
constexpr double kCertain = 1024;

double Reach(const SightEnd& end) { return std::abs(end.tangent) + std::abs(end.normal); }

}  // namespace

void Envelope::Start(const Receiver& receiver) {
  receiver_ = &receiver;
  doubtful_ = false;
  most_uncertain_ = 0;
  crossings_.clear();
  crossing_elements_.clear();
  if (seen_.empty()) seen_.resize(64);
  SightBetween& horizon = seen_[0];
  horizon.low = horizon.high = SightEnd();
  horizon.low.kind = horizon.high.kind = SightEnd::Kind::kHorizon;
  horizon.low.tangent = horizon.low.key = -1;
  horizon.high.tangent = horizon.high.key = 1;
  used_ = 1;
  sectors_.Start(0, 1);
}

bool Envelope::Hides(double low, double high, double near_squared) const {
  const double near = near_squared * kSquareMargin;
  for (std::size_t i = sectors_.Find(low); i < sectors_.size() && sectors_[i].key <= high; ++i)
    if (!(sectors_.FarSquared(i) < near)) return false;
  return true;
}

void Envelope::Add() {
  const auto index = static_cast<std::int32_t>(used_);
  auto low_end = static_cast<std::uint32_t>(2 * used_);
  std::uint32_t high_end = low_end + 1;
  if (++used_ == seen_.size()) seen_.resize(2 * used_);
  const SightBetween& seen = seen_[used_ - 1];
  const Sight& sight = seen.sight;
  most_uncertain_ = std::max({most_uncertain_, seen.low.uncertain, seen.high.uncertain});
  double low = seen.low.key, high = seen.high.key;
  std::size_t i = sectors_.Find(low);
  Align(sight, -1, sectors_.Find(high), high, high_end);
  Align(sight, 1, i, low, low_end);
  if (low < sectors_[i].key || low >= sectors_[i + 1].key) i = sectors_.Find(low);
  const double near = sight.near_squared * kSquareMargin;
  for (; sectors_[i].key < high; ++i) {
    if (sectors_.FarSquared(i) < near) continue;
    const Sector sector = sectors_[i], next = sectors_[i + 1];
    const double from = std::max(sector.key, low), to = std::min(next.key, high);
    if (!(from < to)) continue;
    const std::uint32_t from_end = sector.key >= low ? sector.end : low_end;
    const std::uint32_t to_end = next.key <= high ? next.end : high_end;
    if (sector.sight == Sector::kNothing) {
      i = Take(i, index, from, from_end, to, to_end);
      continue;
    }
    Order order;
    Compare(sight, SightOf(sector), End(from_end), End(to_end), order);
    if (order.first == Nearer::kDoubt) {
      doubtful_ = true;
    } else if (order.changes == 0) {
      if (order.first == Nearer::kYes) i = Take(i, index, from, from_end, to, to_end);
    } else {
      i = TakePieces(i, index, order, from, from_end, to, to_end);
    }
  }
}

std::size_t Envelope::TakePieces(std::size_t sector, std::int32_t sight, const Order& order, double from,
                                 std::uint32_t from_end, double to, std::uint32_t to_end) {
  const ElementId hidden = SightOf(sectors_[sector]).element;
  bool front = order.first == Nearer::kYes;
  for (int piece = 0; piece <= order.changes; ++piece, front = !front) {
    double stop = to;
    std::uint32_t stop_end = to_end;
    if (piece < order.changes) {
      const SightEnd& crossing = order.crossings[piece];
      stop = crossing.key, stop_end = kCrossing + static_cast<std::uint32_t>(crossings_.size());
      crossings_.push_back(crossing);
      crossing_elements_.emplace_back(seen_[static_cast<std::size_t>(sight)].sight.element, hidden);
      most_uncertain_ = std::max(most_uncertain_, crossing.uncertain);
    }
    if (front) sector = Take(sector, sight, from, from_end, stop, stop_end);
    from = stop, from_end = stop_end;
  }
  return sector;
}

void Envelope::Align(const Sight& sight, double inward, std::size_t at, double& key, std::uint32_t& end) {
  const double own = key;
  const std::uint32_t own_end = end;
  const SightEnd& here = End(own_end);
  const double widest = here.uncertain + most_uncertain_;
  if (own - sectors_[at].key > widest && sectors_[at + 1].key - own > widest) return;
  std::size_t begin = at + 1, stop = at + 1;
  while (begin > 0 && own - sectors_[begin - 1].key <= widest) --begin;
  while (stop <= sectors_.size() && sectors_[stop].key - own <= widest) ++stop;
  for (std::size_t i = begin; i < stop; ++i) {
    const SightEnd& other = End(sectors_[i].end);
    if (std::abs(sectors_[i].key - own) > here.uncertain + other.uncertain) continue;
    if (here.SamePlace(other)) {
      key = sectors_[i].key, end = sectors_[i].end;
    } else if ((i == 0 || IsBehind(sight, i - 1, here)) && (i == sectors_.size() || IsBehind(sight, i, here))) {
      if (end == own_end) key = sectors_[i].key, end = sectors_[i].end;
    } else {
      doubtful_ = true;
      // Never hide what may be seen beside it.
      key = sectors_[i].key + inward * kKeyMargin, end = own_end;
      return;
    }
  }
}

bool Envelope::IsBehind(const Sight& sight, std::size_t sector, const SightEnd& at) const {
  if (sectors_[sector].sight == Sector::kNothing) return false;
  if (sectors_.FarSquared(sector) < sight.near_squared * kSquareMargin) return true;
  const Sight& other = SightOf(sectors_[sector]);
  return !sight.part && !other.part && CompareAt(sight, other, at) == Nearer::kNo;
}

void Envelope::AddCrossingError(std::uint32_t crossing, Edge& edge) const {
  const auto& [first, second] = crossing_elements_[crossing];
  AddMeetingError(scene_, *receiver_, scene_.element(first), scene_.element(second), edge);
}

Envelope::Nearer Envelope::CompareAt(const Sight& sight, const Sight& other, const SightEnd& at) const {
  // The reciprocal distances, times both areas.
  const double cross = sight.CrossAlong(at), other_cross = other.CrossAlong(at);
  const double difference = cross * other.area - other_cross * sight.area;
  const double doubt = Reach(at) * (sight.along_doubt * other.area + other.along_doubt * sight.area) +
                       std::abs(cross) * other.area_doubt + std::abs(other_cross) * sight.area_doubt;
  if (std::abs(difference) > kCertain * doubt) return difference > 0 ? Nearer::kYes : Nearer::kNo;
  if (std::abs(difference) > doubt) return Nearer::kDoubt;
  // They meet in this direction: at the place that the end stands for, or it is not the end between them.
  const auto is_here = [&](const Sight& on, double along) {
    return std::abs(along - on.area) <= kCertain * (Reach(at) * on.along_doubt + on.area_doubt);
  };
  const bool here = at.kind == SightEnd::Kind::kHorizon || (is_here(sight, cross) && is_here(other, other_cross));
  if (!here) return Nearer::kDoubt;
  // Which of two that meet at a small angle is in front depends on rounding for some way.
  const double turn = sight.along_normal * other.along_tangent - sight.along_tangent * other.along_normal;
  const double reach = (std::abs(sight.along_tangent) + std::abs(sight.along_normal)) *
                       (std::abs(other.along_tangent) + std::abs(other.along_normal));
  if (at.kind == SightEnd::Kind::kHorizon || std::abs(turn) > kShallow * reach) return Nearer::kEqual;
  const Element &e = scene_.element(sight.element), &f = scene_.element(other.element);
  return e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b ? Nearer::kEqual : Nearer::kDoubt;
}

void Envelope::Compare(const Sight& sight, const Sight& other, const SightEnd& low, const SightEnd& high,
                       Order& order) const {
  if (sight.far_squared < other.near_squared * kSquareMargin) {
    order.first = Nearer::kYes;
  } else if (sight.part || other.part) {
    CompareBent(sight, other, low, high, order);
  } else {
    CompareStraight(sight, other, low, high, order);
  }
}

void Envelope::CompareStraight(const Sight& sight, const Sight& other, const SightEnd& low, const SightEnd& high,
                               Order& order) const {
  // The difference of reciprocal distances is linear in the ray's direction: it changes its sign once at most.
  const Nearer at_low = CompareAt(sight, other, low), at_high = CompareAt(sight, other, high);
  if (at_low == Nearer::kDoubt || at_high == Nearer::kDoubt) return;
  if (at_low == at_high || at_high == Nearer::kEqual || at_low == Nearer::kEqual) {
    if (at_low != Nearer::kEqual || at_high != Nearer::kEqual)
      order.first = at_low == Nearer::kEqual ? at_high : at_low;
    return;
  }
  order.changes = Crossings(sight, other, low, high, order.crossings);
  if (order.changes == 1) order.first = at_low;
}

void Envelope::CompareBent(const Sight& sight, const Sight& other, const SightEnd& low, const SightEnd& high,
                           Order& order) const {
  SightEnd crossings[2];
  const int count = Crossings(sight, other, low, high, crossings);
  if (count < 0) return;
  Nearer before = Nearer::kDoubt;
  for (int i = 0; i <= count; ++i) {
    const Nearer nearer =
        CompareBetween(sight, other, i == 0 ? low.key : crossings[i - 1].key, i == count ? high.key : crossings[i].key);
    if (nearer == Nearer::kDoubt) {
      order.first = Nearer::kDoubt;
      return;
    }
    // Elements may have a point in common that is not in these parts of them, or where they touch.
    if (i == 0) {
      order.first = nearer;
    } else if (nearer != before) {
      order.crossings[order.changes++] = crossings[i - 1];
    }
    before = nearer;
  }
}

int Envelope::Crossings(const Sight& sight, const Sight& other, const SightEnd& low, const SightEnd& high,
                        SightEnd (&crossings)[2]) const {
  const bool ordered = sight.element < other.element;
  const Element& e = scene_.element(ordered ? sight.element : other.element);
  const Element& f = scene_.element(ordered ? other.element : sight.element);
  if (e.carrier == f.carrier) return 0;
  if (IsTangentBetween(e, f, low.key, high.key)) return -1;
  const ElementCrossings points = CrossElements(e, f, scene_.touch_distance());
  int count = 0;
  for (int i = 0; i < points.count; ++i) {
    const Edge edge = VertexEdge(*receiver_, points.point[i]);
    const double uncertain = 6 * scene_.coordinate_error() * edge.q + 16 * kUnitRoundoff;
    if (edge.normal <= 0 || edge.key < low.key - uncertain - low.uncertain ||
        edge.key > high.key + uncertain + high.uncertain)
      continue;
    const double inside = std::min(edge.key - low.key, high.key - edge.key);
    const bool at_low = edge.key - low.key < high.key - edge.key;
    const double doubt = uncertain + (at_low ? low : high).uncertain;
    if (inside <= 0.25 * doubt) {
      // The two meet at the place that the end stands for, or it is not the end between them.
      const SightEnd& end = at_low ? low : high;
      const double squared = (end.tangent * end.tangent + end.normal * end.normal) * edge.q * edge.q;
      if (end.kind != SightEnd::Kind::kHorizon && std::abs(squared - 1) > 1e-9) return -1;
      continue;
    }
    if (inside <= 4 * doubt) return -1;
    SightEnd& crossing = crossings[count++];
    crossing.tangent = edge.tangent, crossing.normal = edge.normal, crossing.key = edge.key;
    crossing.uncertain = uncertain;
    crossing.point = points.point[i];
    crossing.kind = SightEnd::Kind::kVertex;
    crossing.crossing = true;
  }
  if (count == 2 && crossings[1].key < crossings[0].key) std::swap(crossings[0], crossings[1]);
  // Hardly apart: a tangent, as far as one can tell.
  if (count == 2 && !(crossings[1].key - crossings[0].key > 4 * (crossings[0].uncertain + crossings[1].uncertain)))
    return -1;
  return count;
}

bool Envelope::IsTangentBetween(const Element& e, const Element& f, double low, double high) const {
  const Tangencies tangencies = FindTangencies(scene_, e, f);
  for (int i = 0; i < tangencies.count; ++i) {
    Edge edge = VertexEdge(*receiver_, tangencies.place[i]);
    AddMeetingError(scene_, *receiver_, e, f, edge);
    if (MayLieBetween(edge, low, high)) return true;
  }
  return false;
}

Envelope::Nearer Envelope::CompareBetween(const Sight& sight, const Sight& other, double low, double high) const {
  const double key = 0.5 * (low + high);
  const double distance = DistanceOf(sight, key), other_distance = DistanceOf(other, key);
  const double doubt = 1e-12 * std::max(distance, other_distance) + DistanceDoubt(sight, key, distance) +
                       DistanceDoubt(other, key, other_distance);
  if (!(std::abs(distance - other_distance) > doubt)) return Nearer::kDoubt;
  return distance < other_distance ? Nearer::kYes : Nearer::kNo;
}

double Envelope::DistanceDoubt(const Sight& sight, double key, double distance) const {
  const UnitDirection d(key);
  if (sight.part) return flatlight::DistanceDoubt(scene_, *sight.part, *receiver_, d.tangent, d.normal, distance);
  const double cross = d.normal * sight.along_tangent - d.tangent * sight.along_normal;
  return std::abs(distance) * (sight.area_doubt / sight.area + 2 * sight.along_doubt / std::abs(cross));
}

double Envelope::DistanceOf(const Sight& sight, double key) const {
  const UnitDirection direction(key);
  if (sight.part)
    return DistanceAlong(scene_.element(sight.element), *sight.part, *receiver_, direction.tangent, direction.normal);
  return sight.area / (direction.normal * sight.along_tangent - direction.tangent * sight.along_normal);
}

std::size_t Envelope::Take(std::size_t sector, std::int32_t sight, double low, std::uint32_t low_end, double high,
                           std::uint32_t high_end) {
  const Sector old = sectors_[sector];
  const double old_far = sectors_.FarSquared(sector);
  const bool before = low > old.key, after = high < sectors_[sector + 1].key;
  const double far = FarSquared(seen_[static_cast<std::size_t>(sight)].sight, low_end, high_end);
  const Sector parts[2] = {{low, sight, low_end}, {high, old.sight, high_end}};
  const double fars[2] = {far, old_far};
  if (!before) sectors_.Set(sector, sight, far);
  const std::size_t count = (before ? 1u : 0u) + (after ? 1u : 0u);
  if (count > 0) sectors_.Split(sector, before ? parts : parts + 1, before ? fars : fars + 1, count);
  return sector + count;
}

double Envelope::FarSquared(const Sight& sight, std::uint32_t low_end, std::uint32_t high_end) const {
  // In all its directions, as a rule.
  if (low_end + 1 == high_end || sight.far_squared < 1.2 * sight.near_squared) return sight.far_squared;
  const double far = std::max(FarAt(sight, End(low_end)), FarAt(sight, End(high_end)));
  if (sight.part && sight.part->kind == Part::Kind::kConcave) {
    // Between two directions a part is no farther than at the farther end; a hollow one may be, by its bulge.
    const double bulged = std::sqrt(far) + 0.25 * scene_.element(sight.element).length;
    return std::min(sight.far_squared, bulged * bulged * (1 + 1e-10));
  }
  return std::min(sight.far_squared, far * (1 + 1e-10));
}

double Envelope::FarAt(const Sight& sight, const SightEnd& end) const {
  if (sight.part) {
    const double distance = DistanceOf(sight, end.key);
    return distance >= 0 ? distance * distance : kInfinity;
  }
  const double area = sight.area + sight.area_doubt;
  const double cross = sight.CrossAlong(end) - Reach(end) * sight.along_doubt;
  const double squared = end.tangent * end.tangent + end.normal * end.normal;
  return cross > 0 ? area * area * squared / (cross * cross) : kInfinity;
}

}  // namespace flatlight
