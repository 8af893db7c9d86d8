// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_walk.h"

#include "core/plane/intersect.h"
#include "core/scene/element_frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plane/ray_walk.cc"
#include <hwy/foreach_target.h>

#include "core/plane/bvh_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace flatlight {
namespace HWY_NAMESPACE {

// What a search needs besides its ray.
struct World {
  const Scene& scene;
  const Bvh& bvh;

  bool IsSegment(const Bvh::Slot& slot, bool straight) const {
    return straight || scene.elements()[slot.element].kind == Element::Kind::kSegment;
  }
};

// The first crossing of a ray.
struct NearestSearch {
  using Result = NearestCrossing;
  WalkRay ray;
  Line line{{}, {}, 0};
  NearestCrossing result;

  NearestSearch() = default;
  HWY_INLINE NearestSearch(const World& world, const WalkRay& along)
      : ray(along), line(along.from.position, along.direction, world.scene.touch_distance()) {}

  const double& end() const { return result.t; }

  // Meets the element of a slot; false, as a later one may be nearer.
  HWY_INLINE bool Meet(const World& world, std::uint32_t index, bool straight) {
    const Bvh::Slot& slot = world.bvh.slots()[index];
    const bool own = slot.carrier == ray.from.carrier;
    if (world.IsSegment(slot, straight)) {
      double t = 0;
      const bool met = MeetsSegment(line, slot.a, slot.b, t);
      Keep(met & !own, {t, slot.element, index, true});
      return false;
    }
    const Element& arc = world.scene.elements()[slot.element];
    const double touch = world.scene.touch_distance();
    const Crossings crossings = own ? CrossOwnCircle(arc, line.origin, line.direction, touch)
                                    : CrossArc(arc, line.origin, line.direction, touch);
    for (int i = 0; i < crossings.count; ++i) Keep(true, {crossings.t[i], slot.element, index, false});
    return false;
  }

  HWY_INLINE void Keep(bool met, const NearestCrossing& found) {
    const bool first = (found.t < result.t) | ((found.t == result.t) & (found.element < result.element));
    if (met & (found.t > 0) & first) result = found;
  }
};

struct PlacePair {
  RayEnd from;
  RayEnd to;
};

// Something between two places.
struct BlockerSearch {
  using Result = bool;
  WalkRay ray;
  RayEnd to;
  Line line{{}, {}, 0};
  bool result = false;
  double length = 1;

  BlockerSearch() = default;
  HWY_INLINE BlockerSearch(const World& world, const PlacePair& places)
      : ray{places.from, places.to.position - places.from.position},
        to(places.to),
        line(places.from.position, ray.direction, world.scene.touch_distance()) {}

  const double& end() const { return length; }

  // Meets the element of a slot; true if it blocks.
  HWY_INLINE bool Meet(const World& world, std::uint32_t index, bool straight) {
    const Bvh::Slot& slot = world.bvh.slots()[index];
    const bool own = slot.carrier == ray.from.carrier, theirs = slot.carrier == to.carrier;
    if (world.IsSegment(slot, straight)) {
      double t = 0;
      const bool met = MeetsSegment(line, slot.a, slot.b, t);
      result = met & !own & !theirs & (t > 0) & (t < 1);
      return result;
    }
    // Both ends on one circle: nothing of it lies between. One end on it: only its other crossing counts.
    if (own && theirs) return false;
    const Element& arc = world.scene.elements()[slot.element];
    const double touch = world.scene.touch_distance();
    Crossings crossings;
    if (theirs) {
      crossings = CrossOwnCircle(arc, to.position, -line.direction, touch);
      if (crossings.count > 0) crossings.t[0] = 1 - crossings.t[0];
    } else {
      crossings = own ? CrossOwnCircle(arc, line.origin, line.direction, touch)
                      : CrossArc(arc, line.origin, line.direction, touch);
    }
    for (int i = 0; i < crossings.count; ++i) result |= crossings.t[i] > 0 && crossings.t[i] < 1;
    return result;
  }
};

template <typename Search>
HWY_INLINE void Run(const World& world, Search& search) {
  Walk walk;
  PutOff put_off;
  const double touch = world.scene.touch_distance();
  if (!walk.Begin(world.bvh, search.line.origin, search.line.direction, touch, search.end(), put_off)) return;
  const auto meet = [&](std::uint32_t slot, bool straight) HWY_ATTR { return search.Meet(world, slot, straight); };
  while (walk.Step(world.bvh, search.end(), put_off, meet)) {
  }
}

// Several walks take turns, a node each, so that one works while another waits for memory. Input(i) gives what the
// i-th search is made of.
template <typename Search, typename Input>
HWY_INLINE void RunMany(const World& world, std::size_t size, const Input& input, typename Search::Result* results) {
  struct Runner {
    std::size_t index;
    Search search;
    Walk walk;
    PutOff put_off;
  };
  constexpr std::size_t kTurns = 4;
  Runner runners[kTurns];
  Runner* running[kTurns];
  std::size_t count = 0, next = 0;
  const auto start = [&](Runner& runner) HWY_ATTR {
    while (next < size) {
      runner.index = next++;
      runner.search = Search(world, input(runner.index));
      const Line& line = runner.search.line;
      if (runner.walk.Begin(world.bvh, line.origin, line.direction, world.scene.touch_distance(), runner.search.end(),
                            runner.put_off)) {
        return true;
      }
      results[runner.index] = runner.search.result;
    }
    return false;
  };
  for (Runner& runner : runners)
    if (start(runner)) running[count++] = &runner;
  while (count > 0) {
    for (std::size_t turn = 0; turn < count; ++turn) {
      Runner& runner = *running[turn];
      const auto meet = [&](std::uint32_t slot, bool straight)
                            HWY_ATTR { return runner.search.Meet(world, slot, straight); };
      if (runner.walk.Step(world.bvh, runner.search.end(), runner.put_off, meet)) continue;
      results[runner.index] = runner.search.result;
      if (!start(runner)) running[turn--] = running[--count];
    }
  }
}

NearestCrossing Nearest(const Scene& scene, const Bvh& bvh, const WalkRay& ray) {
  const World world{scene, bvh};
  NearestSearch search(world, ray);
  Run(world, search);
  return search.result;
}

void NearestOfMany(const Scene& scene, const Bvh& bvh, std::span<const WalkRay> rays,
                   std::span<NearestCrossing> nearest) {
  RunMany<NearestSearch>(
      {scene, bvh}, rays.size(), [&](std::size_t i) { return rays[i]; }, nearest.data());
}

bool Blocker(const Scene& scene, const Bvh& bvh, const RayEnd& from, const RayEnd& to) {
  const World world{scene, bvh};
  BlockerSearch search(world, {from, to});
  Run(world, search);
  return search.result;
}

void BlockerOfMany(const Scene& scene, const Bvh& bvh, std::span<const RayEnd> from, std::span<const RayEnd> to,
                   std::span<bool> blocked) {
  const auto places = [&](std::size_t i) { return PlacePair{from[i], to[i]}; };
  RunMany<BlockerSearch>({scene, bvh}, from.size(), places, blocked.data());
}

bool Touching(const Scene& scene, const Bvh& bvh, const RayEnd& place) {
  const double touch = scene.touch_distance(), end = 0;
  Walk walk;
  PutOff put_off;
  // The ray of length 0 visits what may be at the place.
  if (!walk.Begin(bvh, place.position, {1, 1}, touch, end, put_off)) return false;
  bool touches = false;
  const auto meet = [&](std::uint32_t index, bool) HWY_ATTR {
    const Bvh::Slot& slot = bvh.slots()[index];
    touches = slot.carrier != place.carrier && DistanceTo(scene.elements()[slot.element], place.position) <= touch;
    return touches;
  };
  while (walk.Step(bvh, end, put_off, meet)) {
  }
  return touches;
}

const RaySearches* Searches() {
  static constexpr RaySearches kSearches{&Nearest, &NearestOfMany, &Blocker, &BlockerOfMany, &Touching};
  return &kSearches;
}

}  // namespace HWY_NAMESPACE
}  // namespace flatlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace flatlight {

HWY_EXPORT(Searches);

const RaySearches& ChosenRaySearches() { return *HWY_DYNAMIC_DISPATCH(Searches)(); }

}  // namespace flatlight
#endif
