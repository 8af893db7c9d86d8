// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/tolerances.h"
#include "core/plane/exact/meeting.h"
#include "core/plane/intersect.h"

namespace flatlight {
namespace {

// Distances that agree to this, relative, are compared with bounds on their errors. Those that agree to these bounds
// may be those of curves that meet; they are compared again so far aside (a key).
constexpr double kClose = 1e-3;
constexpr double kAside = 1e-8;

// Ends of parts are one place to this, relative.
constexpr double kTie = 1e-11;

// How much nearer, relative, hides for certain: near a silhouette a distance is uncertain by the root of the rounding.
constexpr double kBehind = 1e-6;

// Keys of directions that may be one.
constexpr double kSameKey = 1e-13;

// Each piece that is seen splits an interval once, and halves it at every other one.
constexpr int kMaxDepth = 128;

Edge CrossingEdge(const Receiver& receiver, Point2 point) {
  Edge edge = VertexEdge(receiver, point);
  edge.crossing = true;
  return edge;
}

}  // namespace

const std::vector<VisibleInterval>& Sweep::Run(const std::vector<Part>& parts, const Receiver& receiver) {
  parts_ = &parts;
  receiver_ = &receiver;
  left_handed_ = Cross(receiver.tangent, receiver.normal) < 0;
  visible_.clear();
  meetings_.clear();
  active_.clear();
  active_arcs_.clear();
  breaks_.clear();
  far_filter_.Start(parts, receiver);
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    for (const Edge* edge : {&parts[p].first, &parts[p].last}) {
      breaks_.push_back({edge, p, Uncertainty(*edge)});
    }
  }
  SortBreaks(receiver.curvature);
  first_rank_.resize(parts.size());
  last_rank_.resize(parts.size());
  for (std::uint32_t i = 0; i < breaks_.size(); ++i) {
    const std::uint32_t p = breaks_[i].part;
    (breaks_[i].edge == &parts[p].first ? first_rank_ : last_rank_)[p] = i;
  }
  for (std::uint32_t i = 0; i + 1 < breaks_.size(); ++i) {
    const std::uint32_t p = breaks_[i].part;
    const bool arc = parts[p].kind != Part::Kind::kStraight;
    if (i == std::min(first_rank_[p], last_rank_[p])) {
      active_.push_back(p);
      if (arc) active_arcs_.push_back(p);
    } else {
      active_.erase(std::find(active_.begin(), active_.end(), p));
      if (arc) active_arcs_.erase(std::find(active_arcs_.begin(), active_arcs_.end(), p));
    }
    const Break& here = breaks_[i];
    const Break& next = breaks_[i + 1];
    if (active_.empty()) {
      Emit(*here.edge, VisibleInterval::kNothing);
    } else if (active_.size() == 1) {
      Emit(*here.edge, static_cast<std::int32_t>(active_[0]));
    } else if (next.edge->key - here.edge->key <= here.uncertain + next.uncertain) {
      ResolveCoinciding(*here.edge, *next.edge);
    } else {
      Resolve(*here.edge, *next.edge, 0);
    }
  }
  if (!breaks_.empty()) Emit(*breaks_.back().edge, VisibleInterval::kNothing);
  return visible_;
}

double Sweep::Uncertainty(const Edge& edge) const {
  if (edge.kind == Edge::Kind::kTouch) return edge.turn;
  return edge.kind == Edge::Kind::kHorizon ? 0 : 2 * scene_.coordinate_error() * edge.q + 4 * kUnitRoundoff;
}

void Sweep::SortBreaks(double curvature) {
  std::sort(breaks_.begin(), breaks_.end(), [](const Break& l, const Break& r) { return l.edge->key < r.edge->key; });
  for (std::size_t begin = 0; begin < breaks_.size();) {
    std::size_t end = begin + 1;
    while (end < breaks_.size() &&
           breaks_[end].edge->key - breaks_[end - 1].edge->key <= breaks_[end].uncertain + breaks_[end - 1].uncertain) {
      ++end;
    }
    if (end - begin > 1) {
      const auto at = [&](std::size_t i) { return breaks_.begin() + static_cast<std::ptrdiff_t>(i); };
      // theta' = kappa - c q: the nearest falls back most. Nothing falls behind the horizon where the ray begins.
      const auto nearness = [](const Edge& edge) {
        return edge.kind == Edge::Kind::kHorizon && edge.s < 0 ? std::numeric_limits<double>::infinity() : edge.q;
      };
      std::stable_sort(at(begin), at(end),
                       [&](const Break& l, const Break& r) { return nearness(*l.edge) > nearness(*r.edge); });
      // Equal distances: by the next derivative.
      for (std::size_t i = begin; i < end;) {
        std::size_t j = i + 1;
        while (j < end && nearness(*breaks_[j].edge) >= nearness(*breaks_[i].edge) * (1 - 1e-9)) ++j;
        std::stable_sort(at(i), at(j), [&](const Break& l, const Break& r) {
          return Derive(*l.edge, curvature).theta_second < Derive(*r.edge, curvature).theta_second;
        });
        i = j;
      }
    }
    begin = end;
  }
}

double Sweep::DistanceOf(std::uint32_t part, double key) const {
  const Part& p = (*parts_)[part];
  const UnitDirection direction(key);
  return DistanceAlong(scene_.element(p.element), p, *receiver_, direction.tangent, direction.normal);
}

double Sweep::DoubtOf(std::uint32_t part, double key, double distance) const {
  const UnitDirection direction(key);
  return DistanceDoubt(scene_, (*parts_)[part], *receiver_, direction.tangent, direction.normal, distance);
}

bool Sweep::MayMeet(std::uint32_t p, double distance, std::uint32_t other, double other_distance, double key) const {
  const double difference = std::abs(distance - other_distance);
  if (difference > kClose * (distance + other_distance) + 64 * scene_.coordinate_error()) return false;
  return !(difference > DoubtOf(p, key, distance) + DoubtOf(other, key, other_distance));
}

bool Sweep::IsEdgeOn(const Part& part) const {
  return part.first.kind != Edge::Kind::kHorizon && part.last.kind != Edge::Kind::kHorizon &&
         std::abs(part.first.key - part.last.key) <= Uncertainty(part.first) + Uncertainty(part.last);
}

std::int32_t Sweep::Nearest(double key, EdgeOn edge_on) {
  std::int32_t nearest = VisibleInterval::kNothing;
  double best = std::numeric_limits<double>::infinity();
  for (const std::uint32_t p : far_filter_.NotFar(active_, key, kClose)) {
    ++comparisons_;
    if (edge_on == EdgeOn::kLeaveOut && IsEdgeOn((*parts_)[p])) continue;
    const double distance = DistanceOf(p, key);
    bool nearer = nearest == VisibleInterval::kNothing || distance < best;
    if (nearest != VisibleInterval::kNothing) {
      const auto other = static_cast<std::uint32_t>(nearest);
      if (std::max(distance, best) == 0) {
        nearer = InFrontOnward(p, other);
      } else if (MayMeet(p, distance, other, best, key)) {
        nearer = InFront(p, other, key, distance);
      }
    }
    if (nearer) {
      best = distance, nearest = static_cast<std::int32_t>(p);
    }
  }
  return nearest;
}

void Sweep::ResolveCoinciding(const Edge& from, const Edge& to) {
  const double key = 0.5 * (from.key + to.key);
  const std::int32_t other = Nearest(key, EdgeOn::kLeaveOut);
  std::int32_t edge_on = VisibleInterval::kNothing;
  for (const std::uint32_t p : far_filter_.NotFar(active_, key, kClose))
    if (IsEdgeOn((*parts_)[p])) edge_on = static_cast<std::int32_t>(p);
  if (edge_on == VisibleInterval::kNothing) return Emit(from, other);
  // Coinciding edges come in the order of their distance, and between two of them a piece seen edge-on recedes from the
  // one's distance to the other's. What lies between these distances hides the rest of it.
  const double distance = other == VisibleInterval::kNothing ? std::numeric_limits<double>::infinity()
                                                             : DistanceOf(static_cast<std::uint32_t>(other), key);
  if (distance <= from.Distance() * (1 + kTie)) return Emit(from, other);
  Emit(from, edge_on);
  if (distance >= to.Distance() * (1 - kTie)) return;
  const UnitDirection direction(key);
  const Vector2 along = direction.tangent * receiver_->tangent + direction.normal * receiver_->normal;
  Emit(CrossingEdge(*receiver_, receiver_->position + distance * along), other);
}

bool Sweep::InFront(std::uint32_t p, std::uint32_t other, double key, double distance) const {
  // Parts that meet in this direction: the one that is nearer a little aside, on the side where both are.
  const auto starts_here = [&](std::uint32_t index) {
    const Part& part = (*parts_)[index];
    const bool forward = first_rank_[index] < last_rank_[index];
    const Edge& start = forward ? part.first : part.last;
    const Edge& end = forward ? part.last : part.first;
    return start.kind != Edge::Kind::kHorizon && std::abs(start.key - key) < kAside &&
           std::abs(start.key - key) < std::abs(end.key - key) &&
           std::abs(start.Distance() - distance) < 1e3 * kAside * distance;
  };
  const auto width = [&](std::uint32_t index) {
    const Part& part = (*parts_)[index];
    return std::abs(part.first.key - part.last.key);
  };
  // Never beyond the parts themselves.
  const double step = std::min({kAside, 0.25 * width(p), 0.25 * width(other)});
  const double aside = starts_here(p) || starts_here(other) ? step : -step;
  const double direction = std::clamp(key + aside, -1.0, 1.0);
  const double r1 = DistanceOf(p, direction), r2 = DistanceOf(other, direction);
  return r1 != r2 ? r1 < r2 : (*parts_)[p].element < (*parts_)[other].element;
}

bool Sweep::InFrontOnward(std::uint32_t p, std::uint32_t other) const {
  const Part &part = (*parts_)[p], &beside = (*parts_)[other];
  if (std::abs(part.through - beside.through) > kSameKey) return part.through > beside.through;
  return part.lean != beside.lean ? part.lean > beside.lean : part.element < beside.element;
}

void Sweep::Resolve(const Edge& from, const Edge& to, int depth) {
  const double middle = 0.5 * (from.key + to.key);
  const std::int32_t nearest = Nearest(middle, EdgeOn::kCount);
  if (active_.size() > 1 && depth < kMaxDepth) {
    const auto p = static_cast<std::uint32_t>(nearest);
    Edge crossing;
    if (FindArcCrossing(p, from.key, to.key, middle, crossing) || FindCrossing(p, from, to, from, crossing) ||
        FindCrossing(p, from, to, to, crossing)) {
      Resolve(from, crossing, depth + 1);
      Resolve(crossing, to, depth + 1);
      return;
    }
  }
  if (active_.size() > 1) AddTangencies(static_cast<std::uint32_t>(nearest), from.key, to.key);
  Emit(from, nearest);
}

void Sweep::AddTangencies(std::uint32_t nearest, double low, double high) {
  const Element& element = scene_.element((*parts_)[nearest].element);
  for (const std::uint32_t p : element.kind == Element::Kind::kSegment ? active_arcs_ : active_) {
    if (p == nearest) continue;
    const Element& other = scene_.element((*parts_)[p].element);
    if (FollowOneBend(scene_, element, other)) continue;
    const Tangencies tangencies = FindTangencies(scene_, element, other);
    for (int i = 0; i < tangencies.count; ++i) {
      // Where they touch at the receiver's own place they are told apart by their curvature.
      if (Length(tangencies.place[i] - receiver_->position) <= 2 * scene_.touch_distance()) continue;
      Edge edge = VertexEdge(*receiver_, tangencies.place[i]);
      AddMeetingError(scene_, *receiver_, element, other, edge);
      if (MayLieBetween(edge, low, high)) meetings_.push_back({edge, (*parts_)[nearest].element, (*parts_)[p].element});
    }
  }
}

bool Sweep::FindCrossing(std::uint32_t nearest, const Edge& from, const Edge& to, const Edge& at, Edge& crossing) {
  const double distance = DistanceOf(nearest, at.key);
  double best = distance;
  bool found = false;
  for (const std::uint32_t p : far_filter_.NotFar(active_, at.key, kClose, distance)) {
    ++comparisons_;
    if (p == nearest) continue;
    const double other = DistanceOf(p, at.key);
    const bool meets = MayMeet(p, other, nearest, distance, at.key);
    if (!meets && !(other < best)) continue;
    // Straight parts cross once at most: another one is in front somewhere only if it is at an end.
    crossings_.clear();
    AddCrossings(nearest, p, from.key, to.key, crossings_);
    if (meets && crossings_.empty()) AddMeeting(nearest, p, at);
    if (!meets && !crossings_.empty()) best = other;
    if (crossings_.empty()) continue;
    crossing = crossings_.front();
    found = true;
    AddMeeting(nearest, p, crossing);
  }
  return found;
}

void Sweep::AddMeeting(std::uint32_t p, std::uint32_t other, const Edge& edge) {
  if (edge.kind == Edge::Kind::kHorizon) return;
  const ElementId first = (*parts_)[p].element, second = (*parts_)[other].element;
  const Element &e = scene_.element(first), &f = scene_.element(second);
  if (e.carrier == f.carrier || ShareEnd(e, f, edge.point) || FollowOneBend(scene_, e, f)) return;
  Meeting meeting{edge, first, second};
  meeting.edge.turn = meeting.edge.stretch = 0;
  AddMeetingError(scene_, *receiver_, e, f, meeting.edge);
  if (meeting.edge.turn > 0) meetings_.push_back(meeting);
}

bool Sweep::FindArcCrossing(std::uint32_t nearest, double low, double high, double middle, Edge& crossing) {
  // Up to its crossing next to the middle it stays the nearest: so every crossing found is seen.
  crossings_.clear();
  for (const std::uint32_t p : (*parts_)[nearest].kind == Part::Kind::kStraight ? active_arcs_ : active_) {
    ++comparisons_;
    if (p != nearest) AddCrossings(nearest, p, low, high, crossings_);
  }
  if (crossings_.empty()) return false;
  crossing = *std::min_element(crossings_.begin(), crossings_.end(), [&](const Edge& l, const Edge& r) {
    return std::abs(l.key - middle) < std::abs(r.key - middle);
  });
  return true;
}

void Sweep::AddCrossings(std::uint32_t first, std::uint32_t second, double low, double high,
                         std::vector<Edge>& crossings) const {
  const Element& e = scene_.element((*parts_)[first].element);
  const Element& f = scene_.element((*parts_)[second].element);
  if (e.carrier == f.carrier) return;
  const bool both_touch = (*parts_)[first].touches && (*parts_)[second].touches;
  const ElementCrossings points = CrossElements(e, f, scene_.touch_distance());
  for (int i = 0; i < points.count; ++i) {
    if (Length(points.point[i] - receiver_->position) <= 2 * scene_.touch_distance()) continue;
    Edge edge = CrossingEdge(*receiver_, points.point[i]);
    const double uncertain = Uncertainty(edge);
    if (!(edge.normal > 0 && edge.key > low + uncertain && edge.key < high - uncertain)) continue;
    AddMeetingError(scene_, *receiver_, e, f, edge);
    // The place where both pass through the receiver is in no direction.
    if (both_touch && 1 < 8 * (edge.stretch + scene_.touch_distance() * edge.q)) continue;
    crossings.push_back(edge);
  }
}

void Sweep::Emit(const Edge& from, std::int32_t part) {
  VisibleInterval interval;
  interval.begin = BreakBetween(from, part);
  interval.part = part;
  if (part != VisibleInterval::kNothing) {
    // An element that runs counter-clockwise around the receiver has it on its left; theta runs clockwise.
    const auto p = static_cast<std::size_t>(part);
    const bool counter_clockwise = (last_rank_[p] < first_rank_[p]) != left_handed_;
    interval.side = counter_clockwise ? Side::kFront : Side::kBack;
  }
  visible_.push_back(interval);
}

Edge Sweep::BreakBetween(const Edge& from, std::int32_t part) const {
  const std::int32_t before = visible_.empty() ? VisibleInterval::kNothing : visible_.back().part;
  if (before == part || before == VisibleInterval::kNothing || part == VisibleInterval::kNothing) return from;
  // One of the two ends here, as a rule. If not, or behind the other, they cross here, and something hidden behind them
  // ends in the same direction.
  const auto ends_here = [&](std::int32_t index, std::int32_t other) {
    const Part& p = (*parts_)[static_cast<std::size_t>(index)];
    const auto near = [&](const Edge& edge) {
      return edge.kind != Edge::Kind::kHorizon &&
             std::abs(edge.key - from.key) <= 2 * (Uncertainty(edge) + Uncertainty(from)) &&
             std::abs(edge.q - from.q) <= 1e-9 * from.q &&
             !(DistanceOf(static_cast<std::uint32_t>(other), from.key) < edge.Distance() * (1 - kBehind));
    };
    return near(p.first) || near(p.last);
  };
  if (from.kind == Edge::Kind::kHorizon || from.kind == Edge::Kind::kTouch) return from;
  const Element& e = scene_.element((*parts_)[static_cast<std::size_t>(before)].element);
  const Element& f = scene_.element((*parts_)[static_cast<std::size_t>(part)].element);
  if (e.carrier == f.carrier || ShareEnd(e, f, from.point) || FollowOneBend(scene_, e, f)) return from;
  if (ends_here(before, part) || ends_here(part, before)) {
    Edge edge = from;
    const auto p = static_cast<std::uint32_t>(before), q = static_cast<std::uint32_t>(part);
    if (edge.turn == 0 && MayMeet(p, DistanceOf(p, from.key), q, DistanceOf(q, from.key), from.key))
      AddMeetingError(scene_, *receiver_, e, f, edge);
    return edge;
  }
  // One that ends on the other, to rounding, crosses it as that one's line, perhaps not as its own.
  for (const bool own : {true, false}) {
    const ElementCrossings points =
        own ? CrossElements(e, f, scene_.touch_distance()) : CrossElements(f, e, scene_.touch_distance());
    for (int i = 0; i < points.count; ++i) {
      Edge edge = CrossingEdge(*receiver_, points.point[i]);
      if (!(edge.normal > 0 && std::abs(edge.key - from.key) <= 4 * (Uncertainty(edge) + Uncertainty(from)))) continue;
      AddMeetingError(scene_, *receiver_, e, f, edge);
      return edge;
    }
  }
  return from;
}

}  // namespace flatlight
