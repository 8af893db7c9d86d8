// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/visibility_events.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/plane/reference/panel_mesh.h"

namespace flatlight {
namespace {

// Lines end and start so far from the vertices and circles that they touch, which are known to rounding only.
constexpr double kBeside = 1e-9;
// A line within this angle of an element goes along it.
constexpr double kAlong = 1e-9;
// Elements of one curve that meet at a smaller angle go over into each other.
constexpr double kSmooth = 1e-6;
// What is nearer to an element than this part of its length is near.
constexpr double kNear = 0.25;
constexpr double kShort = 1e-2;
constexpr double kGrowth = 4;
// Of the length of a stretch: events nearer to its ends are taken to be there; nearer to each other, for one.
constexpr double kMargin = 1e-6;
constexpr double kClose = 1.0 / 48;
// An event that may change less than this along a stretch is weak there.
constexpr double kStrong = 0.5;
constexpr double kWeakest = 0.02;  // Of those that are kept.
constexpr double kLittle = 0.03;
constexpr double kTurning = 0.5;
// In the chart.
constexpr double kSame = 1e-10;

}  // namespace

EventFinder::EventFinder(const RayCaster& caster, const std::vector<Chart>& charts,
                         const std::vector<std::vector<double>>& meetings)
    : caster_(caster), scene_(caster.scene()), charts_(charts) {
  AddVertices(meetings);
  AddCircles();
}

void EventFinder::AddVertices(const std::vector<std::vector<double>>& meetings) {
  const std::vector<Element>& elements = scene_.elements();
  std::map<std::pair<double, double>, std::size_t> known;
  const auto at = [&](Point2 p) -> Vertex& {
    const auto [it, is_new] = known.try_emplace({p.x, p.y}, vertices_.size());
    if (is_new) vertices_.push_back({p, {}, {}, false});
    return vertices_[it->second];
  };
  for (std::size_t i = 0; i < elements.size(); ++i) {
    for (const bool end : {false, true}) {
      Vertex& vertex = at(end ? elements[i].b : elements[i].a);
      vertex.leaving.push_back((end ? -1.0 : 1.0) * charts_[i].At(end ? 1 : 0).tangent);
      vertex.elements.push_back(static_cast<ElementId>(i));
    }
    for (const double u : meetings[i])
      if (u > 0 && u < 1) at(charts_[i].At(u).position).crossed = true;
  }
  std::erase_if(vertices_, [&](const Vertex& v) {
    if (v.leaving.size() != 2 || v.crossed) return false;
    return scene_.element(v.elements[0]).curve == scene_.element(v.elements[1]).curve &&
           std::abs(Cross(v.leaving[0], v.leaving[1])) < kSmooth && Dot(v.leaving[0], v.leaving[1]) < 0;
  });
}

void EventFinder::AddCircles() {
  std::map<std::uint32_t, std::size_t> known;
  for (std::size_t i = 0; i < scene_.elements().size(); ++i) {
    const Element& e = scene_.elements()[i];
    if (e.kind != Element::Kind::kArc) continue;
    const auto [it, is_new] = known.try_emplace(e.carrier, circles_.size());
    if (is_new) circles_.push_back({e.center, e.radius, {}});
    circles_[it->second].arcs.push_back(static_cast<ElementId>(i));
  }
}

bool EventFinder::Vertex::LetsPass(Vector2 direction) const {
  if (crossed) return false;
  bool left = false, right = false;
  for (const Vector2 along : leaving) {
    const double side = Cross(direction, along);
    if (side > kAlong) left = true;
    if (side < -kAlong) right = true;
  }
  return !(left && right);
}

bool EventFinder::TouchesAt(const Circle& circle, Point2 at, EventPlace& place) const {
  for (const ElementId id : circle.arcs) {
    const double u = charts_[static_cast<std::size_t>(id)].Find(at);
    if (!(u >= 0 && u <= 1)) continue;
    const Side outer = scene_.element(id).Orientation() < 0 ? Side::kFront : Side::kBack;
    place = {PanelMesh::IndexOf(id, outer), u, 0, false};
    return true;
  }
  return false;
}

void EventFinder::AddCandidate(const Vertex* v, const Circle* c, Point2 at, const Vertex* w, const Circle* d, Point2 to,
                               std::vector<Candidate>& candidates) const {
  Candidate line;
  const double length = Length(to - at);
  if (!(length > 4 * kBeside)) return;
  line.direction = (to - at) / length;
  if (c && !TouchesAt(*c, at, line.on_from)) return;
  if (d && !TouchesAt(*d, to, line.on_to)) return;
  line.touches_from = c != nullptr, line.touches_to = d != nullptr;
  line.passes_from = c || v->LetsPass(line.direction);
  line.passes_to = d || w->LetsPass(line.direction);
  if (!line.passes_from && !line.passes_to && !c && !d) return;
  line.from = c ? at + kBeside * (at - c->center) : at + kBeside * line.direction;
  line.to = d ? to + kBeside * (to - d->center) : to - kBeside * line.direction;
  if (v && w) {
    for (const ElementId e : v->elements)
      line.along = line.along || (scene_.element(e).kind == Element::Kind::kSegment &&
                                  std::find(w->elements.begin(), w->elements.end(), e) != w->elements.end());
  }
  candidates.push_back(line);
}

// From vertices that near and far from the place, seen from there in a direction or its opposite.
double EventFinder::Strength(const EventPlace& place, Vector2 direction, double near, double far) const {
  const Chart::Place at = charts_[place.index / 2].At(place.u);
  const double cosine = Cross(at.tangent, direction);
  return cosine * cosine * (1 / near - 1 / far) * at.speed;
}

void EventFinder::LandAll(std::vector<Candidate>& candidates, std::vector<EventPlace>& places) const {
  std::vector<SurfacePoint> from, to;
  for (const Candidate& line : candidates) from.push_back({line.from}), to.push_back({line.to});
  const auto visible = std::make_unique<bool[]>(candidates.size());
  caster_.Visible(from, to, {visible.get(), candidates.size()});
  std::vector<Ray> rays;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& line = candidates[i];
    if (!visible[i] && !line.along) continue;
    const Vector2 beyond = (2 * kBeside) * line.direction;
    lengths.insert(lengths.end(), (line.passes_from ? 1u : 0u) + (line.passes_to ? 1u : 0u),
                   Length(line.to - line.from));
    if (line.passes_from) rays.push_back({{line.touches_from ? line.from : line.from - beyond}, -line.direction});
    if (line.passes_to) rays.push_back({{line.touches_to ? line.to : line.to + beyond}, line.direction});
    const auto touch = [&](EventPlace place) {
      const auto id = static_cast<ElementId>(place.index / 2);
      if (!Reflects(id)) return;
      // The cosine is none, but turns.
      place.strength = kTurning * charts_[place.index / 2].At(place.u).speed / scene_.element(id).radius;
      place.kink = true;
      places.push_back(place);
    };
    if (line.touches_from) touch(line.on_from);
    if (line.touches_to) touch(line.on_to);
  }
  std::vector<std::optional<Hit>> hits(rays.size());
  caster_.ClosestHits(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i] || !Reflects(hits[i]->element)) continue;
    const Side side = Dot(hits[i]->normal, rays[i].direction) < 0 ? Side::kFront : Side::kBack;
    const double u = charts_[static_cast<std::size_t>(hits[i]->element)].Find(hits[i]->position);
    EventPlace place = {PanelMesh::IndexOf(hits[i]->element, side), u, 0, true};
    const double near = hits[i]->distance + kBeside;
    place.strength = Strength(place, rays[i].direction, near, near + lengths[i]);
    if (place.strength > kWeakest) places.push_back(place);
  }
}

// Whether an element goes from the vertex to a point.
bool EventFinder::JoinedTo(const Vertex& vertex, Point2 p) const {
  return std::any_of(vertex.elements.begin(), vertex.elements.end(), [&](ElementId id) {
    const Element& e = scene_.element(id);
    return e.a == p || e.b == p;
  });
}

// In steps that grow from `width` on, by the chart; the place itself too.
void EventFinder::AddAround(std::size_t index, double place, double width, std::vector<EventPlace>& places) {
  if (place > 0 && place < 1) places.push_back({index, place, 1 / width, false});
  for (double step = width; step < 1; step *= kGrowth)
    for (const double u : {place - step, place + step})
      if (u > 0 && u < 1) places.push_back({index, u, 1 / step, false});
}

// Around the feet of a vertex, or of a circle's nearest point, and around that point itself: a gap between two curves
// lets light in from its ends, which is lost within some widths of it.
void EventFinder::AddNear(Point2 p, const Vertex* vertex, const Circle* circle, std::vector<EventPlace>& places) const {
  const double radius = circle ? circle->radius : 0;
  for (std::size_t i = 0; i < charts_.size(); ++i) {
    const auto id = static_cast<ElementId>(i);
    const Element& e = scene_.element(id);
    if (!Reflects(id)) continue;
    // Beyond an end it is that end which is near.
    const double found = charts_[i].Find(p), foot = std::clamp(found, 0.0, 1.0);
    const bool at_end = foot != found;
    if (at_end && (circle || JoinedTo(*vertex, foot == 0 ? e.a : e.b))) continue;
    const Chart::Place at = charts_[i].At(foot);
    const Vector2 up = p - at.position;
    const double height = Length(up), distance = std::abs(height - radius);
    const double reach = e.kind == Element::Kind::kArc ? std::min(e.length, e.radius) : e.length;
    if (!(distance > 2 * scene_.touch_distance() && distance < kNear * reach)) continue;
    if (circle && !(distance < kNear * radius)) continue;
    const Side side = (Dot(up, Left(at.tangent)) > 0) == (height > radius) ? Side::kFront : Side::kBack;
    const Point2 nearest = at.position + (1 - radius / height) * up;
    EventPlace on_circle;
    if (circle && !TouchesAt(*circle, nearest, on_circle)) continue;
    if (!caster_.Visible({at.position, id}, {nearest - kShort * (nearest - at.position)})) continue;
    // A point changes the view over its height; a circle over the chord that is as high.
    const double width = circle ? std::sqrt(2 * radius * distance) : distance;
    AddAround(PanelMesh::IndexOf(id, side), foot, width / at.speed, places);
    if (at_end)
      AddAround(PanelMesh::IndexOf(id, side == Side::kFront ? Side::kBack : Side::kFront), foot, width / at.speed,
                places);
    if (circle) {
      const ElementId arc = static_cast<ElementId>(on_circle.index / 2);
      if (Reflects(arc))
        AddAround(on_circle.index, on_circle.u, width / charts_[on_circle.index / 2].At(on_circle.u).speed, places);
    }
    for (std::size_t k = 0; vertex && k < vertex->elements.size(); ++k) {
      const ElementId own = vertex->elements[k];
      const Element& o = scene_.element(own);
      if (!Reflects(own) || !(distance < kNear * o.length)) continue;
      const double end = o.a == p ? 0 : 1;
      const double own_width = width / charts_[static_cast<std::size_t>(own)].At(end).speed;
      for (const Side own_side : {Side::kFront, Side::kBack})
        AddAround(PanelMesh::IndexOf(own, own_side), end, own_width, places);
    }
  }
}

void EventFinder::Find(std::size_t i, std::vector<EventPlace>& places) const {
  std::vector<Candidate> candidates;
  const auto touch = [&](Point2 from, const Circle& c, double sign, Point2& at) {
    const Vector2 toward = from - c.center;
    const double distance = Length(toward);
    if (!(distance > c.radius)) return false;
    const double cosine = c.radius / distance, sine = std::sqrt((1 - cosine) * (1 + cosine));
    const Vector2 unit = toward / distance;
    at = c.center + c.radius * (cosine * unit + (sign * sine) * Left(unit));
    return true;
  };
  if (i < vertices_.size()) {
    const Vertex& v = vertices_[i];
    for (std::size_t j = i + 1; j < vertices_.size(); ++j)
      AddCandidate(&v, nullptr, v.position, &vertices_[j], nullptr, vertices_[j].position, candidates);
    for (const Circle& c : circles_) {
      Point2 at;
      for (const double sign : {-1.0, 1.0})
        if (touch(v.position, c, sign, at)) AddCandidate(&v, nullptr, v.position, nullptr, &c, at, candidates);
    }
    AddNear(v.position, &v, nullptr, places);
  } else {
    const Circle& c = circles_[i - vertices_.size()];
    for (std::size_t j = i - vertices_.size() + 1; j < circles_.size(); ++j) {
      const Circle& d = circles_[j];
      const Vector2 to = d.center - c.center;
      const double distance = Length(to);
      if (!(distance > 0)) continue;
      const Vector2 unit = to / distance;
      // Normals of common tangents: n.to = R_c -+ R_d.
      for (const double side : {-1.0, 1.0}) {
        const double cosine = (c.radius + side * d.radius) / distance;
        if (!(std::abs(cosine) < 1)) continue;
        const double sine = std::sqrt((1 - cosine) * (1 + cosine));
        for (const double sign : {-1.0, 1.0}) {
          const Vector2 normal = cosine * unit + (sign * sine) * Left(unit);
          AddCandidate(nullptr, &c, c.center + c.radius * normal, nullptr, &d, d.center + (-side * d.radius) * normal,
                       candidates);
        }
      }
    }
    AddNear(c.center, nullptr, &c, places);
  }
  LandAll(candidates, places);
}

namespace {

// Those that `counts`, in order and each once.
template <typename Counts>
Events Sorted(std::size_t elements, const std::vector<std::vector<EventPlace>>& found, const Counts& counts) {
  Events events(2 * elements);
  for (const std::vector<EventPlace>& places : found) {
    for (const EventPlace& place : places)
      if (counts(place)) events[place.index].push_back({place.u, place.strength});
  }
  for (std::vector<Event>& on_side : events) {
    std::sort(on_side.begin(), on_side.end(),
              [](const Event& a, const Event& b) { return a.u != b.u ? a.u < b.u : a.strength > b.strength; });
    std::size_t kept = 0;
    for (const Event& event : on_side) {
      if (kept > 0 && event.u - on_side[kept - 1].u < kSame) {
        on_side[kept - 1].strength = std::max(on_side[kept - 1].strength, event.strength);
      } else {
        on_side[kept++] = event;
      }
    }
    on_side.resize(kept);
  }
  return events;
}

}  // namespace

Events SortedEvents(std::size_t elements, const std::vector<std::vector<EventPlace>>& found) {
  return Sorted(elements, found, [](const EventPlace& place) { return place.strength > kStrong; });
}

Events SortedKinks(std::size_t elements, const std::vector<std::vector<EventPlace>>& found) {
  return Sorted(elements, found, [](const EventPlace& place) { return place.kink; });
}

std::vector<Cell> CellsBetween(const std::vector<Event>& events, double low, double high) {
  const double length = high - low;
  const auto before = [](const Event& event, double u) { return event.u < u; };
  auto next = std::lower_bound(events.begin(), events.end(), low + kMargin * length, before);
  const auto last = std::lower_bound(next, events.end(), high - kMargin * length, before);
  std::vector<Event> strong;
  for (; next < last; ++next)
    if (next->strength * length > kStrong) strong.push_back(*next);
  std::vector<Cell> cells;
  const auto add = [&](double from, double to, double place) {
    if (from < to) cells.push_back({from, to, place, 0});
  };
  // Whether too little happens from one to the next to look there.
  const auto close = [&](const Event& event, const Event& after) {
    const double gap = after.u - event.u;
    return gap < kClose * length && std::max(event.strength, after.strength) * gap < kLittle;
  };
  double from = low;
  for (std::size_t i = 0; i < strong.size();) {
    const double begin = strong[i].u;
    add(from, begin, 0.5 * (from + begin));
    double widest = 0, place = begin;
    for (from = begin, ++i;
         i < strong.size() && close(strong[i - 1], strong[i]) && strong[i].u - begin < 2 * kClose * length; ++i) {
      if (strong[i].u - from > widest) widest = strong[i].u - from, place = 0.5 * (strong[i].u + from);
      from = strong[i].u;
    }
    add(begin, from, place);
  }
  if (!cells.empty()) add(from, high, 0.5 * (from + high));
  return cells;
}

}  // namespace flatlight
