// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/gather.h"

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/plane/exact/gather.cc"
#include <hwy/foreach_target.h>

#include "core/plane/exact/node_view-inl.h"

HWY_BEFORE_NAMESPACE();
namespace flatlight {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Whether everything between two keys and at this squared distance or beyond is hidden. `bin` is that of `low`.
HWY_INLINE bool Hides(const Sectors& sectors, std::int32_t bin, float low, float high, float near_squared) {
  const Floats floats;
  const auto lows = hn::Set(floats, low), highs = hn::Set(floats, high), nears = hn::Set(floats, near_squared);
  std::size_t first = sectors.First(static_cast<std::size_t>(bin));
  std::size_t count = sectors.First(static_cast<std::size_t>(bin) + 1) - first;
  for (std::size_t half = count / 2; HWY_UNLIKELY(count > 16); half = count / 2) {
    if (sectors.keys()[first + half] < low) {
      first += half, count -= half;
    } else {
      count = half;
    }
  }
  const float* key = sectors.keys() + first;
  const float* far_squared = sectors.far_squared() + first;
  while (true) {
    const auto reached = hn::And(hn::Le(hn::LoadU(floats, key), highs), hn::Ge(hn::LoadU(floats, key + 1), lows));
    const auto open = hn::Ge(hn::LoadU(floats, far_squared), nears);
    if (!hn::AllFalse(floats, hn::And(reached, open))) return false;
    key += hn::Lanes(floats), far_squared += hn::Lanes(floats);
    if (HWY_LIKELY(*key > high)) return true;
  }
}

HWY_INLINE std::int32_t BinOf(float key) {
  return std::clamp(static_cast<std::int32_t>((key + 1) * Sectors::kBinsPerKey), 0,
                    static_cast<std::int32_t>(Sectors::kBins) - 1);
}

void Walk(Gatherer& gatherer, const Receiver& receiver) {
  const Bvh& bvh = gatherer.bvh();
  if (bvh.nodes().empty()) return;
  const Sectors& sectors = gatherer.envelope().sectors();
  const BvhNode* nodes = bvh.nodes().data();
  const BvhFrame* frames = bvh.frames().data();
  struct Entry {
    float near_squared;
    float low;
    float high;
    std::int32_t bin;
    std::uint32_t node;
    std::uint32_t frame;
  };
  std::array<Entry, (BvhNode::kWidth - 1) * Bvh::kMaxDepth + 1> stack;
  std::size_t size = 0;
  stack[size++] = {0, -1, 1, 0, 0, 0};
  std::size_t tests = 0;
  LaneViews views;
  const Viewer viewer(receiver);
  while (size > 0) {
    const Entry entry = stack[--size];
    ++tests;
    // What was found since it was put here may hide it by now.
    if (Hides(sectors, entry.bin, entry.low, entry.high, entry.near_squared)) continue;
    const BvhNode& node = nodes[entry.node];
    if (node.kind == BvhNode::Kind::kFrame) {
      stack[size] = entry;
      stack[size].node = node.first, stack[size].frame = node.frame;
      ++size;
      continue;
    }
    viewer.View(node, frames[entry.frame], views);
    unsigned open = 0;
    for (unsigned bits = views.above; bits != 0; bits &= bits - 1) {
      const unsigned lane = static_cast<unsigned>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
      ++tests;
      const bool hidden = Hides(sectors, views.bin[lane], views.low[lane], views.high[lane], views.near_squared[lane]);
      open |= (hidden ? 0u : 1u) << lane;
    }
    const std::size_t base = size;
    for (; open != 0; open &= open - 1) {
      const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(open);
      const auto child = node.first + static_cast<std::uint32_t>(lane);
      if (node.kind == BvhNode::Kind::kInner) {
        const Entry view{views.near_squared[lane], views.low[lane], views.high[lane],
                         views.bin[lane],          child,           entry.frame};
        std::size_t place = size++;
        for (; place > base && stack[place - 1].near_squared < view.near_squared; --place)
          stack[place] = stack[place - 1];
        stack[place] = view;
      } else if (const SightBetween* seen = gatherer.See(bvh.slots()[child], node.kind == BvhNode::Kind::kEnds)) {
        const float low = static_cast<float>(seen->low.key) - kSingle;
        const float high = static_cast<float>(seen->high.key) + kSingle;
        const float near_squared = static_cast<float>(seen->sight.near_squared) * (1 - 4 * kSingle);
        if (!Hides(sectors, BinOf(low), low, high, near_squared)) {
          gatherer.Add(*seen);
        }
      }
    }
  }
  gatherer.AddTests(static_cast<double>(tests));
}

}  // namespace HWY_NAMESPACE
}  // namespace flatlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace flatlight {

HWY_EXPORT(Walk);

void Gatherer::Start(const Receiver& receiver) {
  receiver_ = &receiver;
  left_handed_ = Cross(receiver.tangent, receiver.normal) < 0;
  has_own_ = receiver.element != ElementId::kNone;
  if (has_own_) own_carrier_ = scene_.element(receiver.element).carrier;
  elements_.clear();
  used_parts_ = 0;
  envelope_.Start(receiver);
}

const Envelope& Gatherer::Gather(const Receiver& receiver) {
  Start(receiver);
  HWY_DYNAMIC_DISPATCH(Walk)(*this, receiver);
  return envelope_;
}

const Envelope& Gatherer::GatherAmong(const std::vector<Bvh::Slot>& slots, const Receiver& receiver) {
  Start(receiver);
  if (slots.empty()) return envelope_;
  // From the receiver's own place on, upward or downward: in a convex room that is the order of theta, and parts that
  // come last cost least.
  const std::size_t count = slots.size();
  const auto above = std::upper_bound(
      slots.begin(), slots.end(), receiver.element,
      [](ElementId element, const Bvh::Slot& slot) { return element < static_cast<ElementId>(slot.element); });
  const std::size_t next = above == slots.end() ? 0 : static_cast<std::size_t>(above - slots.begin());
  const std::size_t before = next == 0 ? count - 1 : next - 1;
  const bool upward = Dot(receiver.tangent, slots[before].a - slots[next].a) > 0;
  std::size_t i = upward ? next : before;
  for (std::size_t looked_at = 0; looked_at < count; ++looked_at) {
    if (const SightBetween* seen = See(slots[i], false)) Add(*seen);
    i = upward ? (i + 1 == count ? 0 : i + 1) : (i == 0 ? count : i) - 1;
  }
  tests_ += static_cast<double>(slots.size());
  return envelope_;
}

const SightBetween* Gatherer::See(const Bvh::Slot& slot, bool straight) {
  const auto element = static_cast<ElementId>(slot.element);
  // Where segments of a Bézier meet there is no corner.
  const bool plain = !scene_.traits().has_beziers || scene_.bezier_piece(scene_.element(element)) == nullptr;
  if (plain && (straight || scene_.element(element).kind == Element::Kind::kSegment)) {
    if (has_own_ && slot.carrier == own_carrier_) return nullptr;
    SightBetween& next = envelope_.Next();
    const Seen seen = SeeSegment(scene_, *receiver_, slot.a, slot.b, left_handed_, next);
    next.sight.element = element;
    if (seen != Seen::kDoubt) return seen == Seen::kPart ? &next : nullptr;
  }
  AddParts(element);
  return nullptr;
}

void Gatherer::AddParts(ElementId element) {
  const Parts parts = PartsOf(scene_, element, *receiver_);
  if (parts.count == 0) return;
  elements_.push_back(element);
  for (int i = 0; i < parts.count; ++i) {
    if (used_parts_ == parts_.size()) parts_.emplace_back();
    Part& part = parts_[used_parts_++] = parts.part[i];
    SightBetween& next = envelope_.Next();
    const Seen seen = SeePart(scene_, *receiver_, part, left_handed_, next);
    if (envelope_.Hides(next.low.key - next.low.uncertain, next.high.key + next.high.uncertain,
                        next.sight.near_squared)) {
      continue;
    }
    if (seen == Seen::kPart) {
      envelope_.Add();
    } else {
      envelope_.SetDoubtful();
    }
  }
}

const std::vector<Part>& Gatherer::PartsInDoubt(const Receiver& receiver) {
  in_doubt_.clear();
  for (const ElementId element : elements_) {
    const Parts parts = PartsOf(scene_, element, receiver);
    in_doubt_.insert(in_doubt_.end(), parts.part, parts.part + parts.count);
  }
  return in_doubt_;
}

}  // namespace flatlight
#endif  // HWY_ONCE
