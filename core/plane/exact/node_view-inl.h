// SPDX-License-Identifier: Apache-2.0
// How a node's lanes lie to a receiver, in vector code: included once for every vector unit (see gather.cc).
//
// Everything errs to the side of what may be seen, so results don't depend on the vector unit.
#if defined(FLATLIGHT_CORE_PLANE_EXACT_NODE_VIEW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FLATLIGHT_CORE_PLANE_EXACT_NODE_VIEW_INL_H_
#undef FLATLIGHT_CORE_PLANE_EXACT_NODE_VIEW_INL_H_
#else
#define FLATLIGHT_CORE_PLANE_EXACT_NODE_VIEW_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/math/vec.h"
#include "core/plane/bvh.h"
#include "core/plane/exact/sectors.h"
#include "core/plane/node_lanes-inl.h"
#include "core/scene/scene.h"

HWY_BEFORE_NAMESPACE();
namespace flatlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Bounds on what may be seen of a node's lanes.
struct LaneViews {
  HWY_ALIGN float low[BvhNode::kWidth];  // Keys.
  HWY_ALIGN float high[BvhNode::kWidth];
  HWY_ALIGN float near_squared[BvhNode::kWidth];
  HWY_ALIGN std::int32_t bin[BvhNode::kWidth];  // Of low, among the sectors'.
  unsigned above;                               // Lanes not wholly below the horizon.
};

// Relative errors in single precision stay below this.
constexpr float kSingle = 0x1p-20f;

// Looks at a node's lanes from a receiver.
class Viewer {
 public:
  explicit Viewer(const Receiver& receiver)
      : position_(receiver.position),
        reach_(1 + std::abs(receiver.position.x) + std::abs(receiver.position.y)),
        tangent_x_(static_cast<float>(receiver.tangent.x)),
        tangent_y_(static_cast<float>(receiver.tangent.y)),
        normal_x_(static_cast<float>(receiver.normal.x)),
        normal_y_(static_cast<float>(receiver.normal.y)) {}

  HWY_INLINE void View(const BvhNode& node, const BvhFrame& frame, LaneViews& views) const {
    // In steps of the node's grid.
    const double scale = static_cast<double>(node.inverse_step);
    const double px = (position_.x - frame.center.x) * frame.inverse_size - static_cast<double>(node.origin_x);
    const double py = (position_.y - frame.center.y) * frame.inverse_size - static_cast<double>(node.origin_y);
    const auto x = static_cast<float>(px * scale), y = static_cast<float>(py * scale);
    const auto rounding = static_cast<float>(0x1p-50 * reach_ * frame.inverse_size * scale);
    const float slack = kLeastSlack + rounding + kSingle * (std::abs(x) + std::abs(y));
    const float step = node.step * static_cast<float>(frame.size) * (1 - 2 * kSingle);
    const float step_squared = step * step;
    if (!(std::abs(x) + std::abs(y) < kFarthest)) return ViewAll(node, views);
    const bool ends = node.kind == BvhNode::Kind::kEnds;
    unsigned above = 0;
    for (std::size_t lane = 0; lane < BvhNode::kWidth; lane += kLanes)
      above |= (ends ? ViewEnds(node, lane, x, y, slack, step_squared, views)
                     : ViewBoxes(node, lane, x, y, slack, step_squared, views))
               << lane;
    views.above = above & ((1u << node.count) - 1);
  }

 private:
  using Vec = hn::Vec<Floats>;

  // Nothing is known of the lanes.
  void ViewAll(const BvhNode& node, LaneViews& views) const {
    for (int lane = 0; lane < BvhNode::kWidth; ++lane)
      views.low[lane] = -1, views.high[lane] = 1, views.near_squared[lane] = 0, views.bin[lane] = 0;
    views.above = (1u << node.count) - 1;
  }

  HWY_INLINE unsigned ViewBoxes(const BvhNode& node, std::size_t lane, float x, float y, float slack,
                                float step_squared, LaneViews& views) const {
    const Floats f;
    const auto x0 = hn::Sub(LoadNumbers(node.low_x + lane), hn::Set(f, x + slack));
    const auto y0 = hn::Sub(LoadNumbers(node.low_y + lane), hn::Set(f, y + slack));
    const auto x1 = hn::Sub(LoadNumbers(node.high_x + lane), hn::Set(f, x - slack));
    const auto y1 = hn::Sub(LoadNumbers(node.high_y + lane), hn::Set(f, y - slack));
    StoreNear(step_squared, lane, x0, y0, x1, y1, views);
    const auto reach = hn::Add(hn::Max(hn::Abs(x0), hn::Abs(x1)), hn::Max(hn::Abs(y0), hn::Abs(y1)));
    const auto doubt = hn::Mul(reach, hn::Set(f, kSingle));
    const auto tx = hn::Set(f, tangent_x_), ty = hn::Set(f, tangent_y_);
    const auto nx = hn::Set(f, normal_x_), ny = hn::Set(f, normal_y_);
    const auto tx0 = hn::Mul(tx, x0), tx1 = hn::Mul(tx, x1), ty0 = hn::Mul(ty, y0), ty1 = hn::Mul(ty, y1);
    const auto nx0 = hn::Mul(nx, x0), nx1 = hn::Mul(nx, x1), ny0 = hn::Mul(ny, y0), ny1 = hn::Mul(ny, y1);
    const auto k00 = Key(hn::Add(tx0, ty0), hn::Add(nx0, ny0)), k01 = Key(hn::Add(tx0, ty1), hn::Add(nx0, ny1));
    const auto k10 = Key(hn::Add(tx1, ty0), hn::Add(nx1, ny0)), k11 = Key(hn::Add(tx1, ty1), hn::Add(nx1, ny1));
    const auto margin = hn::Set(f, 2 * kSingle);
    return StoreKeys(lane, hn::Sub(hn::Min(hn::Min(k00, k01), hn::Min(k10, k11)), margin),
                     hn::Add(hn::Max(hn::Max(k00, k01), hn::Max(k10, k11)), margin),
                     hn::Add(hn::Min(tx0, tx1), hn::Min(ty0, ty1)), hn::Add(hn::Max(tx0, tx1), hn::Max(ty0, ty1)),
                     hn::Add(hn::Min(nx0, nx1), hn::Min(ny0, ny1)), hn::Add(hn::Max(nx0, nx1), hn::Max(ny0, ny1)),
                     doubt, views);
  }

  HWY_INLINE unsigned ViewEnds(const BvhNode& node, std::size_t lane, float x, float y, float slack, float step_squared,
                               LaneViews& views) const {
    const Floats f;
    const auto ax = hn::Sub(LoadNumbers(node.low_x + lane), hn::Set(f, x));
    const auto ay = hn::Sub(LoadNumbers(node.low_y + lane), hn::Set(f, y));
    const auto bx = hn::Sub(LoadNumbers(node.high_x + lane), hn::Set(f, x));
    const auto by = hn::Sub(LoadNumbers(node.high_y + lane), hn::Set(f, y));
    // The ends are rounded to the grid.
    const auto off = hn::Set(f, slack + 0.5f);
    StoreNear(step_squared, lane, hn::Sub(hn::Min(ax, bx), off), hn::Sub(hn::Min(ay, by), off),
              hn::Add(hn::Max(ax, bx), off), hn::Add(hn::Max(ay, by), off), views);
    const auto tx = hn::Set(f, tangent_x_), ty = hn::Set(f, tangent_y_);
    const auto nx = hn::Set(f, normal_x_), ny = hn::Set(f, normal_y_);
    const auto ta = hn::Add(hn::Mul(tx, ax), hn::Mul(ty, ay)), tb = hn::Add(hn::Mul(tx, bx), hn::Mul(ty, by));
    const auto na = hn::Add(hn::Mul(nx, ax), hn::Mul(ny, ay)), nb = hn::Add(hn::Mul(nx, bx), hn::Mul(ny, by));
    const auto zero = hn::Zero(f);
    const auto reach_a = hn::Add(hn::Abs(ta), hn::Max(na, zero)), reach_b = hn::Add(hn::Abs(tb), hn::Max(nb, zero));
    const auto least = hn::Min(reach_a, reach_b);
    const auto key_a = hn::Div(ta, hn::Max(reach_a, hn::Set(f, kTiny)));
    const auto key_b = hn::Div(tb, hn::Max(reach_b, hn::Set(f, kTiny)));
    // Each component is off by less than this, and a key by less than both together over its reach.
    const auto doubt = hn::Mul(hn::Set(f, 1.5f), off);
    const auto margin =
        hn::Add(hn::Div(hn::Add(doubt, doubt), hn::Max(least, hn::Set(f, kTiny))), hn::Set(f, 2 * kSingle));
    return StoreKeys(lane, hn::Sub(hn::Min(key_a, key_b), margin), hn::Add(hn::Max(key_a, key_b), margin),
                     hn::Min(ta, tb), hn::Max(ta, tb), hn::Min(na, nb), hn::Max(na, nb), doubt, views);
  }

  // Below the horizon, a key of its side.
  HWY_INLINE Vec Key(Vec tangent, Vec normal) const {
    const Floats f;
    const auto reach = hn::Add(hn::Abs(tangent), hn::Max(normal, hn::Zero(f)));
    return hn::Div(tangent, hn::Max(reach, hn::Set(f, kTiny)));
  }

  HWY_INLINE void StoreNear(float step_squared, std::size_t lane, Vec x0, Vec y0, Vec x1, Vec y1,
                            LaneViews& views) const {
    const Floats f;
    const auto zero = hn::Zero(f);
    const auto dx = hn::Max(hn::Max(x0, hn::Neg(x1)), zero), dy = hn::Max(hn::Max(y0, hn::Neg(y1)), zero);
    hn::Store(hn::Mul(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Set(f, step_squared)), f,
              views.near_squared + lane);
  }

  // Returns a bit for each lane not wholly below the horizon. The components are off by up to `doubt`.
  HWY_INLINE unsigned StoreKeys(std::size_t lane, Vec low, Vec high, Vec left, Vec right, Vec lowest, Vec highest,
                                Vec doubt, LaneViews& views) const {
    const Floats f;
    const Integers integers;
    const auto zero = hn::Zero(f), one = hn::Set(f, 1);
    // Cut by the horizon: everything up to the horizon on the sides it reaches.
    const auto cut = hn::Le(lowest, doubt);
    low = hn::IfThenElse(hn::And(cut, hn::Le(left, doubt)), hn::Neg(one), low);
    high = hn::IfThenElse(hn::And(cut, hn::Ge(hn::Add(right, doubt), zero)), one, high);
    hn::Store(low, f, views.low + lane);
    hn::Store(high, f, views.high + lane);
    const auto bins = hn::Mul(hn::Add(low, one), hn::Set(f, Sectors::kBinsPerKey));
    const auto last_bin = hn::Set(f, static_cast<float>(Sectors::kBins - 1));
    hn::Store(hn::ConvertTo(integers, hn::Min(hn::Max(bins, zero), last_bin)), integers, views.bin + lane);
    return BitsOf(hn::Ge(hn::Add(highest, doubt), zero));
  }

  static constexpr float kTiny = 1e-30f;
  static constexpr float kLeastSlack = 0x1p-10f;  // Of numbers on the grid, in steps.
  static constexpr float kFarthest = 1e15f;       // In steps: squares stay finite.

  Point2 position_;
  double reach_;
  float tangent_x_, tangent_y_, normal_x_, normal_y_;
};

}  // namespace HWY_NAMESPACE
}  // namespace flatlight
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for every vector unit
