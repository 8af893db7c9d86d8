// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_walk.h"

#include "core/math/tolerances.h"
#include "core/plane/intersect.h"
#include "core/scene/element_frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plane/ray_walk.cc"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>

#include "core/plane/block_lanes-inl.h"
#include "core/plane/grid_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace flatlight {
namespace HWY_NAMESPACE {

// What a search needs besides its ray.
struct World {
  const Scene& scene;
  const CurveGrid& grid;

  const Element& ElementIn(const CurveBlock& block, std::uint32_t lane) const {
    return scene.elements()[block.element(lane)];
  }
};

// Whether a ray meets anything in a cell is what no branch predictor foresees, so it is asked once for many segments,
// with a bit for each.
inline constexpr std::uint32_t kBlocksAtOnce = 64 / CurveBlock::kWidth;

template <bool ends>
HWY_INLINE std::uint64_t SegmentsAhead(const Line& line, const CurveBlock* blocks, std::uint32_t count,
                                       std::uint32_t own_carrier, bool has_arcs) {
  std::uint64_t ahead = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t bits = SegmentsAhead<ends>(line, blocks[i], own_carrier, has_arcs);
    ahead |= bits << (CurveBlock::kWidth * i);
  }
  return ahead;
}

// The first of these bits.
struct BlockLane {
  std::uint32_t block;
  std::uint32_t lane;
  HWY_INLINE BlockLane(std::uint32_t first_block, std::uint64_t bits) {
    const auto bit = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
    block = first_block + bit / CurveBlock::kWidth;
    lane = bit % CurveBlock::kWidth;
  }
};

// Where the line meets a segment that it meets.
HWY_INLINE double DistanceInLane(const Line& line, const CurveBlock& block, std::uint32_t lane) {
  double t = 0;
  MeetsSegment(line, {block.ax[lane], block.ay[lane]}, {block.bx[lane], block.by[lane]}, t);
  return t;
}

// The first crossing of a ray.
struct NearestSearch {
  using Result = NearestCrossing;
  using Input = WalkRay;
  // Of the ray no more is kept than its line has not: copied as a whole, it would be read before its parts are written.
  std::uint32_t own_carrier = kNoCarrier;
  Line line{{}, {}, 0};
  NearestCrossing result;

  NearestSearch() = default;
  HWY_INLINE NearestSearch(const World& world, const WalkRay& along)
      : own_carrier(along.from.carrier), line(along.from.position, along.direction, world.scene.touch_distance()) {}

  WalkRay input() const { return {{line.origin, own_carrier}, line.direction}; }
  double end() const { return result.t; }

  // Meets the elements of a cell; false, as a later one may be nearer.
  HWY_INLINE bool Meet(const World& world, const GridCell& cell) {
    const CurveBlock* const blocks = world.grid.blocks().data();
    std::uint64_t ahead = ~std::uint64_t{0};
    if (cell.count <= kBlocksAtOnce) {
      ahead = SegmentsAhead<false>(line, blocks + cell.first, cell.count, own_carrier, cell.kind == GridCell::kCurves);
    }
    if ((ahead & (ahead - 1)) != 0) {
      MeetSegments(blocks, cell);
    } else if (ahead != 0) {
      MeetSegment(blocks, BlockLane(cell.first, ahead));
    }
    if (cell.kind == GridCell::kCurves) {
      for (std::uint32_t index = cell.first; index < cell.first + cell.count; ++index) {
        const CurveBlock& block = blocks[index];
        for (std::uint32_t bits = ArcsNear(line, block); bits != 0; bits &= bits - 1)
          MeetElement(world, block.element(FirstLane(bits)));
      }
    }
    return false;
  }

  // The one segment whose bit is set.
  HWY_INLINE void MeetSegment(const CurveBlock* blocks, const BlockLane& at) {
    const CurveBlock& block = blocks[at.block];
    const double t = DistanceInLane(line, block, at.lane);
    if (t > 0 && t < std::numeric_limits<double>::infinity()) Keep({t, block.element(at.lane), at.block, at.lane});
  }

  // Several, without a question until the nearest is known: how many of them there are can't be foreseen.
  HWY_INLINE void MeetSegments(const CurveBlock* blocks, const GridCell& cell) {
    const Doubles d;
    const Ids ids;
    const auto infinity = hn::Set(d, std::numeric_limits<double>::infinity());
    for (std::uint32_t lane = 0; lane < CurveBlock::kWidth; lane += kBlockLanes) {
      auto nearest = infinity;
      auto where = hn::Zero(ids);  // The block.
      for (std::uint32_t index = cell.first; index < cell.first + cell.count; ++index) {
        const CurveBlock& block = blocks[index];
        const LaneMeeting meeting = MeetLanes(line, block, lane);
        auto met = hn::And(meeting.met, hn::And(hn::Gt(meeting.t, hn::Zero(d)), hn::Lt(meeting.t, nearest)));
        met = hn::AndNot(OfCarrier(block, lane, own_carrier), met);
        if (cell.kind == GridCell::kCurves) met = hn::AndNot(IsArc(block, lane), met);
        nearest = hn::IfThenElse(met, meeting.t, nearest);
        where = hn::IfThenElse(hn::RebindMask(ids, met), hn::Set(ids, index), where);
      }
      const double t = hn::GetLane(hn::MinOfLanes(d, nearest));
      if (t <= result.t && t < std::numeric_limits<double>::infinity()) {
        HWY_ALIGN std::uint64_t index[kBlockLanes];
        hn::Store(where, ids, index);
        std::uint32_t bits = BlockBits(hn::Eq(nearest, hn::Set(d, t)));
        do {
          const std::uint32_t at = FirstLane(bits), block = static_cast<std::uint32_t>(index[at]);
          Keep({t, blocks[block].element(lane + at), block, lane + at});
          bits &= bits - 1;
        } while (HWY_UNLIKELY(bits != 0));
      }
    }
  }

  HWY_INLINE bool MeetElement(const World& world, std::uint32_t index) {
    const Element& element = world.scene.elements()[index];
    const double touch = world.scene.touch_distance();
    const bool own = element.carrier == own_carrier;
    Crossings crossings;
    if (element.kind == Element::Kind::kSegment) {
      if (!own) crossings = CrossSegment(element, line.origin, line.direction, touch);
    } else {
      crossings = own ? CrossOwnCircle(element, line.origin, line.direction, touch)
                      : CrossArc(element, line.origin, line.direction, touch);
    }
    for (int i = 0; i < crossings.count; ++i)
      if (crossings.t[i] > 0 && crossings.t[i] < std::numeric_limits<double>::infinity()) Keep({crossings.t[i], index});
    return false;
  }

  HWY_INLINE void Keep(const NearestCrossing& found) {
    if (found.t < result.t || (found.t == result.t && found.element < result.element)) result = found;
  }
};

struct PlacePair {
  RayEnd from;
  RayEnd to;
};

// Something between two places.
struct BlockerSearch {
  using Result = bool;
  using Input = PlacePair;
  WalkRay ray;
  RayEnd to;
  Line line{{}, {}, 0};
  bool result = false;

  BlockerSearch() = default;
  HWY_INLINE BlockerSearch(const World& world, const PlacePair& places)
      : ray{places.from, places.to.position - places.from.position},
        to(places.to),
        line(places.from.position, ray.direction, world.scene.touch_distance()) {}

  PlacePair input() const { return {ray.from, to}; }
  double end() const { return 1; }

  // Meets the elements of a cell; true if one blocks.
  HWY_INLINE bool Meet(const World& world, const GridCell& cell) {
    const CurveBlock* const blocks = world.grid.blocks().data();
    const bool has_arcs = cell.kind == GridCell::kCurves;
    for (std::uint32_t begin = 0; begin < cell.count; begin += kBlocksAtOnce) {
      const std::uint32_t first = cell.first + begin, count = std::min(cell.count - begin, kBlocksAtOnce);
      std::uint64_t ahead = SegmentsAhead<true>(line, blocks + first, count, ray.from.carrier, has_arcs);
      for (; ahead != 0; ahead &= ahead - 1) {
        const BlockLane at(first, ahead);
        const double t = DistanceInLane(line, blocks[at.block], at.lane);
        if (t > 0 && t < 1 && blocks[at.block].carrier(at.lane) != to.carrier) return result = true;
      }
    }
    if (!has_arcs) return false;
    for (std::uint32_t index = cell.first; index < cell.first + cell.count; ++index) {
      const CurveBlock& block = blocks[index];
      for (std::uint32_t bits = ArcsNear(line, block); bits != 0; bits &= bits - 1)
        if (MeetElement(world, block.element(FirstLane(bits)))) return true;
    }
    return false;
  }

  HWY_INLINE bool MeetElement(const World& world, std::uint32_t index) {
    const Element& element = world.scene.elements()[index];
    const bool own = element.carrier == ray.from.carrier, theirs = element.carrier == to.carrier;
    const double touch = world.scene.touch_distance();
    Crossings crossings;
    if (element.kind == Element::Kind::kSegment) {
      if (!own && !theirs) crossings = CrossSegment(element, line.origin, line.direction, touch);
    } else if (own && theirs) {
      // Both ends on one circle: nothing of it lies between.
    } else if (theirs) {
      // One end on it: only its other crossing counts.
      crossings = CrossOwnCircle(element, to.position, -line.direction, touch);
      if (crossings.count > 0) crossings.t[0] = 1 - crossings.t[0];
    } else {
      crossings = own ? CrossOwnCircle(element, line.origin, line.direction, touch)
                      : CrossArc(element, line.origin, line.direction, touch);
    }
    for (int i = 0; i < crossings.count; ++i) result |= crossings.t[i] > 0 && crossings.t[i] < 1;
    return result;
  }
};

// Whether an element passes through a place.
struct TouchSearch {
  using Result = bool;
  using Input = RayEnd;
  RayEnd place;
  Line line;
  bool result = false;

  TouchSearch(const World& world, const RayEnd& at)
      : place(at), line(at.position, {1, 1}, world.scene.touch_distance()) {}

  const RayEnd& input() const { return place; }
  double end() const { return 0; }

  HWY_INLINE bool Meet(const World& world, const GridCell& cell) {
    const CurveBlock* const blocks = world.grid.blocks().data();
    for (std::uint32_t index = cell.first; index < cell.first + cell.count; ++index) {
      const CurveBlock& block = blocks[index];
      for (std::uint32_t bits = LanesAround(place.position, 2 * world.scene.touch_distance(), block); bits != 0;
           bits &= bits - 1)
        if (MeetElement(world, block.element(FirstLane(bits)))) return true;
    }
    return false;
  }

  HWY_INLINE bool MeetElement(const World& world, std::uint32_t index) {
    const Element& element = world.scene.elements()[index];
    return result =
               element.carrier != place.carrier && DistanceTo(element, place.position) <= world.scene.touch_distance();
  }
};

// A ray without a direction meets nothing.
HWY_INLINE bool HasDirection(Vector2 direction) {
  const double size = std::max(std::abs(direction.x), std::abs(direction.y));
  return size > 0 && size < std::numeric_limits<double>::infinity();
}

// Where the places of a ray round by more than the cells' margin allows, everything is looked at. Begins anew: a search
// that is handed to what is not inlined would be in memory, not in registers.
template <typename Search>
HWY_NOINLINE typename Search::Result MeetAll(const World& world, typename Search::Input input) {
  Search search(world, input);
  for (std::uint32_t index = 0; index < world.scene.elements().size(); ++index)
    if (search.MeetElement(world, index)) break;
  return search.result;
}

// The place where a walk begins; false if none is needed, or no more: then the search is done.
template <typename Search>
HWY_INLINE bool Begin(const World& world, Search& search, GridWalk& walk, GridPlace& at) {
  const CurveGrid& grid = world.grid;
  if (grid.frames().empty() || !HasDirection(search.line.direction)) return false;
  const GridFrame& frame = grid.frames()[0];
  const GridCell& first = grid.cells()[frame.CellAt(0, 0)];
  if (frame.columns * frame.rows == 1 && first.kind <= GridCell::kCurves) {
    search.Meet(world, first);
    return false;
  }
  const Point2 origin = search.line.origin;
  const double farthest = std::max({1.0, std::abs(origin.x), std::abs(origin.y)});
  if (HWY_UNLIKELY(farthest > grid.reach())) {
    search.result = MeetAll<Search>(world, search.input());
    return false;
  }
  walk = GridWalk(search.line);
  return walk.Begin(grid, search.end(), at);
}

template <typename Search>
HWY_INLINE typename Search::Result Run(const World& world, const typename Search::Input& input) {
  Search search(world, input);
  GridWalk walk;
  GridPlace at;
  if (Begin(world, search, walk, at)) walk.Run(world, at, search);
  return search.result;
}

// Some searches at a time, each in steps: memory brings the first cells of all while others are prepared. Input(i)
// gives what the i-th search is made of.
template <typename Search, typename Input>
HWY_INLINE void RunMany(const World& world, std::size_t size, const Input& input, typename Search::Result* results) {
  struct Runner {
    Search search;
    GridWalk walk;
    GridPlace at;
    bool walks;
  };
  constexpr std::size_t kTogether = 16;
  Runner runners[kTogether];
  const CurveGrid& grid = world.grid;
  for (std::size_t begin = 0; begin < size; begin += kTogether) {
    const std::size_t count = std::min(kTogether, size - begin);
    for (std::size_t i = 0; i < count; ++i) {
      Runner& runner = runners[i];
      runner.search = Search(world, input(begin + i));
      runner.walks = Begin(world, runner.search, runner.walk, runner.at);
      if (runner.walks) hwy::Prefetch(grid.cells().data() + runner.at.cell);
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!runners[i].walks) continue;
      const GridCell cell = grid.cells()[runners[i].at.cell];
      if (cell.kind > GridCell::kCurves) continue;
      const char* const block = reinterpret_cast<const char*>(grid.blocks().data() + cell.first);
      for (std::size_t line = 0; line < sizeof(CurveBlock); line += 64) hwy::Prefetch(block + line);
    }
    for (std::size_t i = 0; i < count; ++i) {
      Runner& runner = runners[i];
      if (runner.walks) runner.walk.Run(world, runner.at, runner.search);
      results[begin + i] = runner.search.result;
    }
  }
}

NearestCrossing Nearest(const Scene& scene, const CurveGrid& grid, const WalkRay& ray) {
  const World world{scene, grid};
  return Run<NearestSearch>(world, ray);
}

void NearestOfMany(const Scene& scene, const CurveGrid& grid, std::span<const WalkRay> rays,
                   std::span<NearestCrossing> nearest) {
  RunMany<NearestSearch>(
      {scene, grid}, rays.size(), [&](std::size_t i) { return rays[i]; }, nearest.data());
}

bool Blocker(const Scene& scene, const CurveGrid& grid, const RayEnd& from, const RayEnd& to) {
  const World world{scene, grid};
  return Run<BlockerSearch>(world, {from, to});
}

void BlockerOfMany(const Scene& scene, const CurveGrid& grid, std::span<const RayEnd> from, std::span<const RayEnd> to,
                   std::span<bool> blocked) {
  const auto places = [&](std::size_t i) { return PlacePair{from[i], to[i]}; };
  RunMany<BlockerSearch>({scene, grid}, from.size(), places, blocked.data());
}

bool Touching(const Scene& scene, const CurveGrid& grid, const RayEnd& place) {
  const World world{scene, grid};
  return Run<TouchSearch>(world, place);
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
