// SPDX-License-Identifier: Apache-2.0
// How lines and places lie to the lanes of a block of curves, in vector code: included once for every vector unit.
//
// Segments are met by the operations of MeetsSegment, in the same order: so results don't depend on the vector unit.
#if defined(FLATLIGHT_CORE_PLANE_BLOCK_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FLATLIGHT_CORE_PLANE_BLOCK_LANES_INL_H_
#undef FLATLIGHT_CORE_PLANE_BLOCK_LANES_INL_H_
#else
#define FLATLIGHT_CORE_PLANE_BLOCK_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "core/math/vec.h"
#include "core/plane/curve_grid.h"
#include "core/plane/intersect.h"
#include "core/plane/mask_byte.h"

HWY_BEFORE_NAMESPACE();
namespace flatlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, CurveBlock::kWidth>;
using Ids = hn::RebindToUnsigned<Doubles>;
inline constexpr std::uint32_t kBlockLanes = hn::MaxLanes(Doubles());  // At once.

template <typename Mask>
HWY_INLINE std::uint32_t BlockBits(Mask mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Doubles(), mask, bits);
  return NumberOf(bits[0]);
}

HWY_INLINE std::uint32_t FirstLane(std::uint32_t lanes) {
  return static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes));
}

// How a line meets the lanes of a block: see MeetsSegment.
struct LaneMeeting {
  hn::Vec<Doubles> t;
  hn::Mask<Doubles> met;
};

HWY_INLINE LaneMeeting MeetLanes(const Line& line, const CurveBlock& block, std::uint32_t lane) {
  const Doubles d;
  const auto ox = hn::Set(d, line.origin.x), oy = hn::Set(d, line.origin.y);
  const auto dx = hn::Set(d, line.direction.x), dy = hn::Set(d, line.direction.y);
  const auto inverse = hn::Set(d, line.inverse_length_squared), slack = hn::Set(d, line.slack);
  const auto x0 = hn::Load(d, block.ax + lane), y0 = hn::Load(d, block.ay + lane);
  const auto x1 = hn::Load(d, block.bx + lane), y1 = hn::Load(d, block.by + lane);
  const auto ax = hn::Sub(x0, ox), ay = hn::Sub(y0, oy), bx = hn::Sub(x1, ox), by = hn::Sub(y1, oy);
  const auto ex = hn::Sub(x1, x0), ey = hn::Sub(y1, y0);
  const auto side_a = hn::Sub(hn::Mul(dx, ay), hn::Mul(dy, ax)), side_b = hn::Sub(hn::Mul(dx, by), hn::Mul(dy, bx));
  const auto to_a = hn::Mul(hn::Add(hn::Mul(ax, dx), hn::Mul(ay, dy)), inverse);
  const auto to_b = hn::Mul(hn::Add(hn::Mul(bx, dx), hn::Mul(by, dy)), inverse);
  const auto denominator = hn::Sub(hn::Mul(dx, ey), hn::Mul(dy, ex));
  const auto near = hn::Min(to_a, to_b);
  const auto quotient = hn::Div(hn::Sub(hn::Mul(ax, ey), hn::Mul(ay, ex)), denominator);
  const auto crossing = hn::IfThenElse(hn::Eq(denominator, hn::Zero(d)), near, quotient);
  const auto met = hn::And(hn::Le(hn::Min(side_a, side_b), slack), hn::Ge(hn::Max(side_a, side_b), hn::Neg(slack)));
  return {hn::Min(hn::Max(crossing, near), hn::Max(to_a, to_b)), met};
}

HWY_INLINE hn::Mask<Doubles> IsArc(const CurveBlock& block, std::uint32_t lane) {
  const hn::RebindToSigned<Doubles> integers;
  const auto ids = hn::BitCast(integers, hn::Load(Ids(), block.id + lane));
  return hn::RebindMask(Doubles(), hn::Lt(ids, hn::Zero(integers)));
}

// Where the ends of segments, and of chords of arcs, lie as seen from a place.
struct LaneEnds {
  hn::Vec<Doubles> ax, ay, bx, by;
};

HWY_INLINE LaneEnds EndsFrom(Point2 place, const CurveBlock& block, std::uint32_t lane) {
  const Doubles d;
  const auto x = hn::Set(d, place.x), y = hn::Set(d, place.y);
  return {hn::Sub(hn::Load(d, block.ax + lane), x), hn::Sub(hn::Load(d, block.ay + lane), y),
          hn::Sub(hn::Load(d, block.bx + lane), x), hn::Sub(hn::Load(d, block.by + lane), y)};
}

// Lanes whose arc the line may meet ahead of its origin: an arc of at most a quarter leaves its chord by at most 0.21
// of the chord's length.
HWY_INLINE std::uint32_t ArcsNear(const Line& line, const CurveBlock& block) {
  const Doubles d;
  const auto dx = hn::Set(d, line.direction.x), dy = hn::Set(d, line.direction.y);
  const auto bulge = hn::Set(d, 0.25 * line.length), slack = hn::Set(d, line.slack);
  std::uint32_t bits = 0;
  for (std::uint32_t lane = 0; lane < CurveBlock::kWidth; lane += kBlockLanes) {
    const auto [ax, ay, bx, by] = EndsFrom(line.origin, block, lane);
    const auto chord = hn::Add(hn::Abs(hn::Sub(bx, ax)), hn::Abs(hn::Sub(by, ay)));
    const auto aside = hn::Add(hn::Mul(chord, bulge), slack);
    const auto side_a = hn::Sub(hn::Mul(dx, ay), hn::Mul(dy, ax)), side_b = hn::Sub(hn::Mul(dx, by), hn::Mul(dy, bx));
    const auto way_a = hn::Add(hn::Mul(ax, dx), hn::Mul(ay, dy)), way_b = hn::Add(hn::Mul(bx, dx), hn::Mul(by, dy));
    const auto near = hn::And(hn::Le(hn::Min(side_a, side_b), aside), hn::Ge(hn::Max(side_a, side_b), hn::Neg(aside)));
    const auto ahead = hn::Ge(hn::Max(way_a, way_b), hn::Neg(aside));
    bits |= BlockBits(hn::And(IsArc(block, lane), hn::And(near, ahead))) << lane;
  }
  return bits;
}

// Lanes whose element may come as near to a place.
HWY_INLINE std::uint32_t LanesAround(Point2 place, double distance, const CurveBlock& block) {
  const Doubles d;
  std::uint32_t bits = 0;
  for (std::uint32_t lane = 0; lane < CurveBlock::kWidth; lane += kBlockLanes) {
    const auto [ax, ay, bx, by] = EndsFrom(place, block, lane);
    const auto chord = hn::Add(hn::Abs(hn::Sub(bx, ax)), hn::Abs(hn::Sub(by, ay)));
    const auto away = hn::Add(hn::Mul(chord, hn::Set(d, 0.25)), hn::Set(d, distance));
    const auto along_x = hn::And(hn::Le(hn::Min(ax, bx), away), hn::Ge(hn::Max(ax, bx), hn::Neg(away)));
    const auto along_y = hn::And(hn::Le(hn::Min(ay, by), away), hn::Ge(hn::Max(ay, by), hn::Neg(away)));
    bits |= BlockBits(hn::And(along_x, along_y)) << lane;
  }
  return bits;
}

// Lanes of a carrier.
HWY_INLINE hn::Mask<Doubles> OfCarrier(const CurveBlock& block, std::uint32_t lane, std::uint32_t carrier) {
  const Ids ids;
  return hn::RebindMask(Doubles(), hn::Eq(hn::ShiftRight<32>(hn::Load(ids, block.id + lane)), hn::Set(ids, carrier)));
}

// Lanes whose segment the line meets, as MeetLanes has it, but for those of one carrier, those that lie behind the
// origin, and with `ends` those that lie beyond t = 1. Where what is left is met may still be behind, or beyond.
template <bool ends>
HWY_INLINE std::uint32_t SegmentsAhead(const Line& line, const CurveBlock& block, std::uint32_t own_carrier,
                                       bool has_arcs) {
  const Doubles d;
  const auto dx = hn::Set(d, line.direction.x), dy = hn::Set(d, line.direction.y), slack = hn::Set(d, line.slack);
  std::uint32_t bits = 0;
  for (std::uint32_t lane = 0; lane < CurveBlock::kWidth; lane += kBlockLanes) {
    const auto [ax, ay, bx, by] = EndsFrom(line.origin, block, lane);
    const auto side_a = hn::Sub(hn::Mul(dx, ay), hn::Mul(dy, ax)), side_b = hn::Sub(hn::Mul(dx, by), hn::Mul(dy, bx));
    const auto way_a = hn::Add(hn::Mul(ax, dx), hn::Mul(ay, dy)), way_b = hn::Add(hn::Mul(bx, dx), hn::Mul(by, dy));
    auto met = hn::And(hn::Le(hn::Min(side_a, side_b), slack), hn::Ge(hn::Max(side_a, side_b), hn::Neg(slack)));
    met = hn::And(met, hn::Gt(hn::Max(way_a, way_b), hn::Zero(d)));
    if constexpr (ends) {
      const auto near = hn::Mul(hn::Min(way_a, way_b), hn::Set(d, line.inverse_length_squared));
      met = hn::And(met, hn::Lt(near, hn::Set(d, 1)));
    }
    met = hn::AndNot(OfCarrier(block, lane, own_carrier), met);
    if (has_arcs) met = hn::AndNot(IsArc(block, lane), met);
    bits |= BlockBits(met) << lane;
  }
  return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace flatlight
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for every vector unit
