// SPDX-License-Identifier: Apache-2.0
// The walk of a line through the tree, in vector code: included once for every vector unit (see ray_walk.cc).
//
// It only leaves out what the line cannot meet; what it meets is found by the same scalar arithmetic on every machine,
// so results don't depend on the vector unit.
#if defined(FLATLIGHT_CORE_PLANE_BVH_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FLATLIGHT_CORE_PLANE_BVH_WALK_INL_H_
#undef FLATLIGHT_CORE_PLANE_BVH_WALK_INL_H_
#else
#define FLATLIGHT_CORE_PLANE_BVH_WALK_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/math/tolerances.h"
#include "core/plane/bvh.h"
#include "core/plane/node_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace flatlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE unsigned FirstBit(unsigned bits) { return static_cast<unsigned>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)); }

// Nodes to visit, the next one on top. The key of a node holds the distance at which the ray enters it, rounded down to
// a float without its three last bits, which tell the lane. Floats that are not negative are in the order of their
// bits.
class NodeStack {
 public:
  struct Entry {
    std::int32_t key;
    std::uint32_t node;
  };

  HWY_INLINE void Clear() { size_ = 0; }
  HWY_INLINE std::size_t size() const { return size_; }
  // The node that Pop would give; anything if there is none.
  HWY_INLINE std::uint32_t Top() const {
    const std::size_t top = size_ > 0 ? size_ - 1 : 0;
    return first_[top] + static_cast<std::uint32_t>(keys_[top] & 7);
  }
  HWY_INLINE Entry Pop() {
    --size_;
    return {keys_[size_], first_[size_] + static_cast<std::uint32_t>(keys_[size_] & 7)};
  }

  // Pushes the lanes of a mask, which is not 0, except the nearest, and returns that.
  HWY_INLINE std::uint32_t PushAllButNearest(const float* enter, unsigned lanes, std::uint32_t first) {
#if HWY_MAX_BYTES >= 32
    const Integers integers;
    const auto bits = hn::BitCast(integers, hn::Load(Floats(), enter));
    const auto keys = hn::OrAnd(hn::Iota(integers, 0), bits, hn::Set(integers, ~7));
    const std::uint8_t mask_bits[8] = {static_cast<std::uint8_t>(lanes)};
    const auto mask = hn::LoadMaskBits(integers, mask_bits);
    const std::int32_t nearest =
        hn::GetLane(hn::MinOfLanes(integers, hn::IfThenElse(mask, keys, hn::Set(integers, 0x7fffffff))));
    const auto sorted = SortDescending(hn::IfThenElse(mask, keys, hn::Set(integers, -1)));
    hn::StoreU(sorted, integers, keys_ + size_);
    hn::StoreU(hn::Set(hn::Rebind<std::uint32_t, Floats>(), first), hn::Rebind<std::uint32_t, Floats>(),
               first_ + size_);
    size_ += hwy::PopCount(lanes) - 1;
#else
    const std::size_t base = size_;
    for (; lanes != 0; lanes &= lanes - 1) {
      const unsigned lane = FirstBit(lanes);
      std::int32_t key = 0;
      hwy::CopyBytes<4>(&enter[lane], &key);
      key = (key & ~7) | static_cast<std::int32_t>(lane);
      std::size_t place = size_++;
      for (; place > base && keys_[place - 1] < key; --place) keys_[place] = keys_[place - 1];
      keys_[place] = key;
      first_[size_ - 1] = first;
    }
    const std::int32_t nearest = keys_[--size_];
#endif
    return first + static_cast<std::uint32_t>(nearest & 7);
  }

 private:
#if HWY_MAX_BYTES >= 32
  // By a bitonic network (Batcher 1968): no branch depends on the data.
  static HWY_INLINE hn::Vec<Integers> SortDescending(hn::Vec<Integers> v) {
    const Integers integers;
    const auto upper_pairs = hn::MaskFromVec(hn::LoadDup128(integers, kUpperPair));
    auto r = hn::Reverse2(integers, v);
    v = hn::OddEven(hn::Min(v, r), hn::Max(v, r));
    r = hn::Reverse4(integers, v);
    v = hn::IfThenElse(upper_pairs, hn::Min(v, r), hn::Max(v, r));
    r = hn::Reverse2(integers, v);
    v = hn::OddEven(hn::Min(v, r), hn::Max(v, r));
    r = hn::Reverse8(integers, v);
    v = hn::ConcatUpperLower(integers, hn::Min(v, r), hn::Max(v, r));
    r = hn::Shuffle1032(v);
    v = hn::IfThenElse(upper_pairs, hn::Min(v, r), hn::Max(v, r));
    r = hn::Reverse2(integers, v);
    return hn::OddEven(hn::Min(v, r), hn::Max(v, r));
  }

  alignas(16) static constexpr std::int32_t kUpperPair[4] = {0, 0, -1, -1};
#endif
  static constexpr std::size_t kCapacity = std::size_t{BvhNode::kWidth} * (Bvh::kMaxDepth + 1);
  std::size_t size_;
  std::int32_t keys_[kCapacity];
  std::uint32_t first_[kCapacity];
};

// A ray made ready for the tree: its direction is scaled to a largest component of 1.
class TreeRay {
 public:
  TreeRay() = default;
  HWY_INLINE TreeRay(Point2 origin, Vector2 direction, double touch)
      : origin_(origin), size_(std::max(std::abs(direction.x), std::abs(direction.y))), touch_(touch) {
    inverse_ = {Inverse(size_, direction.x), Inverse(size_, direction.y)};
    const double inverse_size = 1 / size_;
    direction_ = {direction.x * inverse_size, direction.y * inverse_size};
    dx_ = static_cast<float>(direction_.x);
    dy_ = static_cast<float>(direction_.y);
    spread_ = std::abs(dx_) + std::abs(dy_);
    inverse_x_ = static_cast<float>(inverse_.x);
    inverse_y_ = static_cast<float>(inverse_.y);
    near_x_ = dx_ >= 0 ? 0 : 16;
    near_y_ = dy_ >= 0 ? 8 : 24;
  }

  // A ray without a direction meets nothing.
  HWY_INLINE bool HasDirection() const { return size_ > 0 && size_ < std::numeric_limits<double>::infinity(); }

  // The ray in coordinates of a frame. (No initial values: most rays need no more than one.)
  struct InFrame {
    float x, y;  // Where it enters the frame: distances count from here.
    float last;  // Where it ends, rounded up.
    std::int32_t last_key;
    float doubt;         // How far curves and rays may be off.
    std::size_t bottom;  // Of its nodes on the stack.
    double begin;        // The distance of (x, y), in units of the scene.
    double inverse_size;
  };

  // From where the ray enters the box; false if it misses that.
  HWY_INLINE bool Enter(const Box& box, const BvhFrame& frame, InFrame& ray) const {
    // Places along the ray round by less than this.
    const double doubt = 16 * kUnitRoundoff * std::max({1.0, std::abs(origin_.x), std::abs(origin_.y)});
    const double x0 = (box.low.x - doubt - origin_.x) * inverse_.x, x1 = (box.high.x + doubt - origin_.x) * inverse_.x;
    const double y0 = (box.low.y - doubt - origin_.y) * inverse_.y, y1 = (box.high.y + doubt - origin_.y) * inverse_.y;
    ray.begin = std::max(std::max(0.0, std::min(x0, x1)), std::min(y0, y1));
    const double leave = std::min(std::max(x0, x1), std::max(y0, y1));
    ray.bottom = 0;
    ray.inverse_size = frame.inverse_size;
    ray.x = static_cast<float>((origin_.x - frame.center.x + ray.begin * direction_.x) * ray.inverse_size);
    ray.y = static_cast<float>((origin_.y - frame.center.y + ray.begin * direction_.y) * ray.inverse_size);
    ray.doubt = static_cast<float>((touch_ + doubt) * ray.inverse_size) + 0x1p-20f;
    return ray.begin <= leave;
  }

  // `end` is where the ray ends, in units of the direction given.
  HWY_INLINE void SetEnd(double end, InFrame& ray) const {
    ray.last = static_cast<float>(std::min((end * size_ - ray.begin) * ray.inverse_size, 1e30)) * (1 + 0x1p-20f);
    std::int32_t bits = 0;
    hwy::CopyBytes<4>(&ray.last, &bits);
    ray.last_key = bits | 7;
  }

  // The lanes whose boxes the ray meets, and where it enters them.
  HWY_INLINE unsigned MeetBoxes(const BvhNode& node, const InFrame& ray, float* enter) const {
    const Floats floats;
    const std::uint8_t* const numbers = node.low_x;
    const auto inverse_x = hn::Set(floats, inverse_x_), inverse_y = hn::Set(floats, inverse_y_);
    const auto step = hn::Set(floats, node.step);
    const auto step_x = hn::Mul(step, inverse_x), step_y = hn::Mul(step, inverse_y);
    const auto x = hn::Mul(hn::Sub(hn::Set(floats, node.origin_x), hn::Set(floats, ray.x)), inverse_x);
    const auto y = hn::Mul(hn::Sub(hn::Set(floats, node.origin_y), hn::Set(floats, ray.y)), inverse_y);
    const auto last = hn::Set(floats, ray.last);
    unsigned bits = 0;
    for (std::size_t lane = 0; lane < BvhNode::kWidth; lane += kLanes) {
      // A node keeps the sides that the ray leaves by 16 bytes away from those that it enters by.
      const auto enter_x = hn::MulAdd(LoadNumbers(numbers + near_x_ + lane), step_x, x);
      const auto enter_y = hn::MulAdd(LoadNumbers(numbers + near_y_ + lane), step_y, y);
      const auto leave_x = hn::MulAdd(LoadNumbers(numbers + (near_x_ ^ 16) + lane), step_x, x);
      const auto leave_y = hn::MulAdd(LoadNumbers(numbers + (near_y_ ^ 16) + lane), step_y, y);
      const auto in = hn::Max(hn::Max(enter_x, enter_y), hn::Zero(floats));
      hn::Store(in, floats, enter + lane);
      bits |= BitsOf(hn::Le(in, hn::Min(hn::Min(leave_x, leave_y), last))) << lane;
    }
    return bits;
  }

  // Segments whose ends lie on both sides of the line, or so near it that rounding may hide that, and that are not
  // wholly behind the ray's origin.
  HWY_INLINE unsigned MeetEnds(const BvhNode& node, const InFrame& ray) const {
    const Floats floats;
    const auto dx = hn::Set(floats, dx_), dy = hn::Set(floats, dy_);
    // The side of origin + step * (qx, qy) is step * (dx qy - dy qx) plus that of the grid's origin.
    const auto step = hn::Set(floats, node.step);
    const auto x = hn::Sub(hn::Set(floats, node.origin_x), hn::Set(floats, ray.x));
    const auto y = hn::Sub(hn::Set(floats, node.origin_y), hn::Set(floats, ray.y));
    const auto step_dx = hn::Mul(step, dx), step_dy = hn::Mul(step, dy);
    const auto side = hn::NegMulAdd(dy, x, hn::Mul(dx, y)), way = hn::MulAdd(dx, x, hn::Mul(dy, y));
    // Ends are off by half a step in each coordinate.
    const auto aside = hn::MulAdd(step, hn::Set(floats, 0.52f * spread_), hn::Set(floats, ray.doubt * spread_));
    const auto low = hn::Neg(aside);
    unsigned bits = 0;
    for (std::size_t lane = 0; lane < BvhNode::kWidth; lane += kLanes) {
      const auto ax = LoadNumbers(node.low_x + lane), ay = LoadNumbers(node.low_y + lane);
      const auto bx = LoadNumbers(node.high_x + lane), by = LoadNumbers(node.high_y + lane);
      const auto side_a = hn::MulAdd(ay, step_dx, hn::NegMulAdd(ax, step_dy, side));
      const auto side_b = hn::MulAdd(by, step_dx, hn::NegMulAdd(bx, step_dy, side));
      const auto way_a = hn::MulAdd(ax, step_dx, hn::MulAdd(ay, step_dy, way));
      const auto way_b = hn::MulAdd(bx, step_dx, hn::MulAdd(by, step_dy, way));
      const auto between = hn::And(hn::Le(hn::Min(side_a, side_b), aside), hn::Ge(hn::Max(side_a, side_b), low));
      bits |= BitsOf(hn::And(between, hn::Ge(hn::Max(way_a, way_b), low))) << lane;
    }
    return bits & ((1u << node.count) - 1);
  }

 private:
  // Never infinite, so that nothing becomes NaN: a ray along an axis leaves a box's stripe far away.
  static HWY_INLINE double Inverse(double size, double component) {
    return std::copysign(std::min(size / std::abs(component), 1e30), component);
  }

  Point2 origin_;
  double size_ = 0;
  double touch_ = 0;
  Vector2 inverse_;
  Vector2 direction_;
  float dx_, dy_;
  float spread_;
  float inverse_x_, inverse_y_;
  std::uint32_t near_x_, near_y_;  // Where a node keeps the sides that the ray enters by.
};

// What a walk has put off: nodes, and the frames around the present one.
struct PutOff {
  // Frames lie in each other, and sizes fall by kLeastExtent from one to the next, from 1 to 2^-28.
  static constexpr std::size_t kMostFrames = 4;

  NodeStack nodes;
  std::size_t frame_count;
  TreeRay::InFrame frames[kMostFrames];
};

// A walk through the tree, one node after another. (Apart from PutOff, so that it may live in registers.)
class Walk {
 public:
  Walk() = default;

  // Prepares the walk of a ray from 0 to `end`, in units of the direction given; false if it meets nothing.
  HWY_INLINE bool Begin(const Bvh& bvh, Point2 origin, Vector2 direction, double touch, double end, PutOff& put_off) {
    line_ = TreeRay(origin, direction, touch);
    put_off.nodes.Clear();
    put_off.frame_count = 0;
    index_ = 0;
    if (bvh.nodes().empty() || !line_.HasDirection() || !line_.Enter(bvh.bounds(), bvh.frames()[0], ray_)) return false;
    line_.SetEnd(end, ray_);
    return ray_.last >= 0;
  }

  // Visits one node; false when none is left. Calls `visit(slot, straight)` for slots that the line may meet, roughly
  // from near to far; `straight` is false where it may be an arc. `end` may shrink meanwhile, and `visit` answers true
  // to end the walk.
  template <typename Visit>
  HWY_INLINE bool Step(const Bvh& bvh, const double& end, PutOff& put_off, const Visit& visit) {
    const BvhNode* const nodes = bvh.nodes().data();
    const BvhNode& node = nodes[index_];
    unsigned bits = 0;
    if (node.kind <= BvhNode::Kind::kBoxes) {
      HWY_ALIGN float enter[BvhNode::kWidth];
      bits = line_.MeetBoxes(node, ray_, enter);
      if (node.kind == BvhNode::Kind::kInner && bits != 0) {
        index_ = put_off.nodes.PushAllButNearest(enter, bits, node.first);
        hwy::Prefetch(nodes + index_);
        hwy::Prefetch(nodes + put_off.nodes.Top());
        return true;
      }
    } else if (node.kind == BvhNode::Kind::kEnds) {
      const char* const data = reinterpret_cast<const char*>(bvh.slots().data() + node.first);
      for (std::size_t line = 0; line < sizeof(Bvh::Slot) * BvhNode::kWidth; line += 64) hwy::Prefetch(data + line);
      bits = line_.MeetEnds(node, ray_);
    } else {
      const BvhFrame& frame = bvh.frames()[node.frame];
      const Vector2 half{frame.size, frame.size};
      TreeRay::InFrame inner;
      if (line_.Enter({frame.center - half, frame.center + half}, frame, inner)) {
        put_off.frames[put_off.frame_count++] = ray_;
        ray_ = inner;
        ray_.bottom = put_off.nodes.size();
        line_.SetEnd(end, ray_);
        index_ = node.first;
        return true;
      }
    }
    if (bits != 0) {
      const bool straight = node.kind == BvhNode::Kind::kEnds;
      do {
        if (visit(node.first + FirstBit(bits), straight)) return false;
        bits &= bits - 1;
      } while (bits != 0);
      line_.SetEnd(end, ray_);
    }
    // On to the nearest node left.
    while (true) {
      while (put_off.nodes.size() == ray_.bottom) {
        if (put_off.frame_count == 0) return false;
        ray_ = put_off.frames[--put_off.frame_count];
        line_.SetEnd(end, ray_);
      }
      const NodeStack::Entry entry = put_off.nodes.Pop();
      if (entry.key <= ray_.last_key) {
        index_ = entry.node;
        return true;
      }
    }
  }

 private:
  TreeRay line_;
  TreeRay::InFrame ray_;
  std::uint32_t index_;
};

}  // namespace HWY_NAMESPACE
}  // namespace flatlight
HWY_AFTER_NAMESPACE();

#endif  // include guard, once for every vector unit
