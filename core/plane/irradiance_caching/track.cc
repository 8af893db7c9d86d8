// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/track.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "core/math/tolerances.h"
#include "core/plane/walls.h"
#include "core/scene/bezier_chain.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Whether b goes on where a ends and bends alike.
bool BendsOn(const Scene& scene, const Element& a, const Element& b) {
  if (!GoesOn(a, b)) return false;
  const BezierPiece *of_a = scene.bezier_piece(a), *of_b = scene.bezier_piece(b);
  const bool one_bezier = of_a && of_b && of_a->bezier == of_b->bezier;
  const double end = FrameAt(a, 1).curvature, begin = FrameAt(b, 0).curvature;
  return one_bezier || std::abs(end - begin) <= kSameDirection * std::abs(end);
}

// Whether a free point carries on a row that begins at `first` and has come to `last`.
bool InRow(const Scene& scene, const RayCaster& caster, const Receiver& first, const Receiver& last,
           const Receiver& next) {
  if (next.element != first.element || Length(next.normal - first.normal) > 8 * kUnitRoundoff) return false;
  if (first.element != ElementId::kNone && scene.element(first.element).kind != Element::Kind::kSegment) return false;
  const Vector2 from_first = next.position - first.position;
  if (std::abs(Dot(first.normal, from_first)) > 4 * scene.coordinate_error()) return false;
  return caster.Visible({last.position, last.element}, {next.position, next.element});
}

// Whether light goes to and fro between two elements, which makes it vary without limit where they meet.
bool Exchange(const Scene& scene, std::size_t element, ElementId other) {
  return !scene.curve_of(static_cast<ElementId>(element)).reflectance.IsBlack() &&
         !scene.curve_of(other).reflectance.IsBlack();
}

// A smooth run of a curve's elements, and where walls divide it: light may jump there, and no record reaches past it.
struct Run {
  std::size_t first = 0, last = 0;
  std::vector<double> walls;   // By arc length of the curve, in order; those that are nearly one are one.
  std::vector<char> exchange;  // Which of these reflect to the run.

  void AddWalls(const Scene& scene, const Walls& all) {
    std::vector<std::pair<double, char>> found;
    for (std::size_t e = first; e < last; ++e)
      for (const Wall& wall : all.On(e))
        found.emplace_back(scene.elements()[e].arc_begin + wall.at, Exchange(scene, e, wall.other));
    std::sort(found.begin(), found.end());
    const double near = 4 * scene.touch_distance();
    for (const auto& [at, reflects] : found) {
      if (walls.empty() || at - walls.back() > near) {
        walls.push_back(at), exchange.push_back(reflects);
      } else {
        exchange.back() = exchange.back() || reflects;
      }
    }
  }
};

}  // namespace

Track::Track(const Scene& scene, std::size_t first, std::size_t last, Side side)
    : scene_(&scene), first_(first), last_(last), curve_(scene.elements()[first].curve), side_(side) {}

Track::Track(const Scene& scene, const Receiver& origin) : scene_(&scene), origin_(origin) {
  if (origin.element == ElementId::kNone) return;
  const Element& element = scene.element(origin.element);
  curve_ = element.curve;
  side_ = Dot(FrontNormal(element, origin.position), origin.normal) > 0 ? Side::kFront : Side::kBack;
}

Receiver Track::At(double coordinate) const {
  if (first_ == last_) {
    Receiver receiver = origin_;
    receiver.position = origin_.position + coordinate * origin_.tangent;
    return receiver;
  }
  const auto begin = scene_->elements().begin();
  const auto from = begin + static_cast<std::ptrdiff_t>(first_), to = begin + static_cast<std::ptrdiff_t>(last_);
  // A point on a joint belongs to the piece that starts there.
  const auto element =
      std::prev(std::upper_bound(from + 1, to, coordinate, [](double s, const Element& e) { return s < e.arc_begin; }));
  const double fraction = std::clamp((coordinate - element->arc_begin) / element->length, 0.0, 1.0);
  const ElementFrame frame = FrameAt(*element, fraction);
  const double sign = side_ == Side::kFront ? 1 : -1;
  Receiver receiver;
  receiver.position = frame.position;
  receiver.tangent = frame.tangent;
  receiver.normal = sign * frame.normal;
  receiver.curvature = sign * frame.curvature;
  receiver.element = static_cast<ElementId>(element - begin);
  receiver.arc_length = coordinate;
  if (const BezierPiece* on = scene_->bezier_piece(*element); on && on->bends) {
    const Bezier& bezier = scene_->beziers()[on->bezier];
    PlaceOnBezier(*element, bezier, bezier.AtLength(fraction * element->length, on->from, on->to), sign, receiver);
  }
  return receiver;
}

Tracks TracksOf(const Scene& scene, const RayCaster& caster) {
  Tracks tracks;
  const std::vector<Element>& elements = scene.elements();
  // Where the smooth run of each element begins; the end of the list ends the last one.
  std::vector<std::size_t> begin_of(elements.size() + 1, elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e)
    begin_of[e] = e > 0 && BendsOn(scene, elements[e - 1], elements[e]) ? begin_of[e - 1] : e;
  std::map<std::size_t, Run> runs;  // By first element.
  std::optional<Walls> all_walls;
  // By run, side, and number of walls before.
  std::map<std::tuple<std::size_t, Side, std::ptrdiff_t>, std::uint32_t> parts;
  const auto add = [&](const Track& track) {
    tracks.tracks.push_back(track);
    tracks.points.emplace_back();
    tracks.corners.emplace_back();
    return static_cast<std::uint32_t>(tracks.tracks.size() - 1);
  };
  for (const Probe& probe : scene.probes()) {
    const Receiver* row = nullptr;  // Where it began,
    const Receiver* last = nullptr;
    std::uint32_t row_track = 0;
    for (const Receiver& receiver : probe.receivers) {
      TrackPlace place;
      if (probe.curve != CurveId::kNone && receiver.element != ElementId::kNone &&
          scene.element(receiver.element).curve == probe.curve) {
        const std::size_t first = begin_of[static_cast<std::size_t>(receiver.element)];
        const Side side = Dot(FrontNormal(scene.element(receiver.element), receiver.position), receiver.normal) > 0
                              ? Side::kFront
                              : Side::kBack;
        Run& run = runs[first];
        if (run.last == 0) {
          run.first = first, run.last = first + 1;
          while (begin_of[run.last] == first) ++run.last;
          if (!all_walls) all_walls.emplace(scene);
          run.AddWalls(scene, *all_walls);
        }
        const auto walls = std::upper_bound(run.walls.begin(), run.walls.end(), receiver.arc_length);
        const auto [part, is_new] = parts.try_emplace({first, side, walls - run.walls.begin()}, 0);
        if (is_new) {
          part->second = add(Track(scene, run.first, run.last, side));
          const auto next = static_cast<std::size_t>(walls - run.walls.begin());
          tracks.corners.back() = {next > 0 && run.exchange[next - 1] != 0,
                                   next < run.walls.size() && run.exchange[next] != 0};
        }
        place = {part->second, receiver.arc_length};
        row = nullptr;
      } else {
        if (!row || !InRow(scene, caster, *row, *last, receiver)) {
          row = &receiver;
          row_track = add(Track(scene, receiver));
        }
        last = &receiver;
        place = {row_track, Dot(row->tangent, receiver.position - row->position)};
      }
      tracks.points[place.track].push_back(place.at);
      tracks.of_point.push_back(place);
    }
  }
  for (std::vector<double>& points : tracks.points) std::sort(points.begin(), points.end());
  return tracks;
}

}  // namespace flatlight
