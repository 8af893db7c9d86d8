// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/emitter_reach.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/math/tolerances.h"
#include "core/plane/bvh.h"
#include "core/plane/path_tracing/emitter_sampler.h"
#include "core/plane/shaft.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// What a look costs: some 10 ns for which way two pieces face, up to a microsecond for what lies between them.
constexpr std::size_t kMostPairs = 20'000;
constexpr std::size_t kMostPassages = 400;
// A tree of so many is built in a fraction of a millisecond.
constexpr std::size_t kMostElementsInTree = 512;
// With more emitters than are weighed one by one nobody asks which of them are hidden.
constexpr std::size_t kMostPiecesInTree = EmitterSampler::kMostWeighed;
// Of a probe of free points; others are looked at as one box.
constexpr std::size_t kMostSinglePoints = 32;

// Where light may arrive.
struct Place {
  Corners corners;
  const Element* element = nullptr;
  std::optional<Vector2> normal;  // Light comes from its side only; absent: from both.
};

class Looker {
 public:
  Looker(const Scene& scene, const Bvh* bvh, EmitterReach& reach) : scene_(scene), bvh_(bvh), reach_(reach) {}

  // Notes which pieces may light the place. False if it has looked at too much; then all count as lighting everything.
  bool Look(const Place& place, bool EmitterReach::Piece::*lights) {
    if (pairs_left_ < reach_.pieces.size()) {
      for (EmitterReach::Piece& piece : reach_.pieces) piece.lights_points = piece.lights_reflectors = true;
      return false;
    }
    pairs_left_ -= reach_.pieces.size();
    for (EmitterReach::Piece& piece : reach_.pieces) {
      if (MayLight(piece.id, place)) piece.*lights = true;
    }
    return true;
  }

 private:
  bool MayLight(ElementId id, const Place& place) {
    const Element& emitter = scene_.element(id);
    if (!Faces(emitter, scene_.curve_of(id).two_sided, place)) return false;
    if (bvh_ == nullptr || passages_left_ == 0) return true;
    --passages_left_;
    OwnCarriers own{.to = emitter.carrier};
    if (place.element != nullptr) own.from = place.element->carrier;
    const Passage passage = PassageBetween(scene_, *bvh_, place.corners, CornersOf(emitter), own);
    if (passage == Passage::kHidden) return false;
    ++reach_.ways;
    reach_.clear_ways += passage == Passage::kClear ? 1 : 0;
    return true;
  }

  bool Faces(const Element& emitter, bool two_sided, const Place& place) const {
    const bool straight = emitter.kind == Element::Kind::kSegment;
    if (place.element != nullptr && place.element->carrier == emitter.carrier && straight) return false;
    // Far above rounding, and above what a point that touches another curve is moved by.
    constexpr double doubt = 2 * kFarthestOnward;
    if (straight && !two_sided) {
      const Vector2 along = emitter.b - emitter.a;
      if (!AnyOf(place.corners, [&](Point2 p) { return Cross(along, p - emitter.a) > -doubt * emitter.length; }))
        return false;
    }
    const bool flat = place.element == nullptr || place.element->kind == Element::Kind::kSegment;
    if (flat && place.normal.has_value()) {
      const Point2 foot = place.corners.point[0];
      if (!AnyOf(CornersOf(emitter), [&](Point2 p) { return Dot(*place.normal, p - foot) > -doubt; })) return false;
    }
    return true;
  }

  template <typename Test>
  static bool AnyOf(const Corners& corners, const Test& test) {
    return std::any_of(corners.point.begin(), corners.point.begin() + static_cast<std::ptrdiff_t>(corners.count), test);
  }

  const Scene& scene_;
  const Bvh* bvh_;
  EmitterReach& reach_;
  std::size_t pairs_left_ = kMostPairs;
  std::size_t passages_left_ = kMostPassages;
};

bool LookFromProbe(const Scene& scene, const Probe& probe, Looker& looker) {
  if (probe.receivers.empty()) return true;
  if (probe.on_curve) {
    const Curve& curve = scene.curve(probe.curve);
    const Receiver& first = probe.receivers.front();
    const bool front = Dot(first.normal, FrontNormal(scene.element(first.element), first.position)) > 0;
    for (std::uint32_t e = curve.first_element; e < curve.first_element + curve.element_count; ++e) {
      const Element& element = scene.elements()[e];
      Place place{CornersOf(element), &element, {}};
      if (element.kind == Element::Kind::kSegment) {
        const Vector2 normal = FrontNormal(element, element.a);
        place.normal = front ? normal : -normal;
      }
      if (!looker.Look(place, &EmitterReach::Piece::lights_points)) return false;
    }
  } else if (probe.receivers.size() <= kMostSinglePoints) {
    for (const Receiver& receiver : probe.receivers) {
      const Element* element = receiver.element == ElementId::kNone ? nullptr : &scene.element(receiver.element);
      const Place place{CornersOf(receiver.position), element, receiver.normal};
      if (!looker.Look(place, &EmitterReach::Piece::lights_points)) return false;
    }
  } else {
    return looker.Look({CornersOf(Box{probe.low, probe.high}), nullptr, {}}, &EmitterReach::Piece::lights_points);
  }
  return true;
}

bool LookFromReflectors(const Scene& scene, Looker& looker) {
  for (const Curve& curve : scene.curves()) {
    if (curve.reflectance.IsBlack()) continue;
    for (std::uint32_t e = curve.first_element; e < curve.first_element + curve.element_count; ++e) {
      const Element& element = scene.elements()[e];
      if (!looker.Look({CornersOf(element), &element, {}}, &EmitterReach::Piece::lights_reflectors)) return false;
    }
  }
  return true;
}

}  // namespace

bool EmitterReach::LightsReflectors() const {
  return std::any_of(pieces.begin(), pieces.end(), [](const Piece& piece) { return piece.lights_reflectors; });
}

EmitterReach ReachOfEmitters(const Scene& scene) {
  EmitterReach reach;
  for (const Curve& curve : scene.curves()) {
    if (!curve.Emits()) continue;
    for (std::uint32_t e = curve.first_element; e < curve.first_element + curve.element_count; ++e)
      reach.pieces.push_back({static_cast<ElementId>(e), false, false});
  }
  std::optional<Bvh> bvh;
  if (!reach.pieces.empty() && reach.pieces.size() <= kMostPiecesInTree &&
      scene.elements().size() <= kMostElementsInTree) {
    bvh.emplace(scene);
  }
  Looker looker(scene, bvh ? &*bvh : nullptr, reach);
  for (const Probe& probe : scene.probes()) {
    if (!LookFromProbe(scene, probe, looker)) return reach;
  }
  LookFromReflectors(scene, looker);
  return reach;
}

}  // namespace flatlight
