// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/gather.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flatlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Margins of the culling, in keys and relative in distance: far above rounding, far below what would cost time.
constexpr double kKeyMargin = 1e-10;
constexpr double kDepthMargin = 1e-10;
constexpr double kLengthMargin = 1e-13;

// The keys that a box may cover above the horizon, and its distance.
struct BoxView {
  double low = 1, high = -1, distance = 0;

  BoxView(const Box& box, const Receiver& receiver) {
    const Point2 x = receiver.position;
    const double dx = std::max({box.low.x - x.x, 0.0, x.x - box.high.x});
    const double dy = std::max({box.low.y - x.y, 0.0, x.y - box.high.y});
    distance = std::sqrt(dx * dx + dy * dy);
    double low_tangent = kInfinity, high_tangent = -kInfinity;
    int above = 0;
    for (const Point2 corner : {box.low, Point2{box.high.x, box.low.y}, box.high, Point2{box.low.x, box.high.y}}) {
      const double t = Dot(receiver.tangent, corner - x), n = Dot(receiver.normal, corner - x);
      low_tangent = std::min(low_tangent, t), high_tangent = std::max(high_tangent, t);
      if (n <= 0) continue;
      ++above;
      const double key = t / (std::abs(t) + n);
      low = std::min(low, key), high = std::max(high, key);
    }
    if (above == 0) return;
    // Cut by the horizon (or around the receiver): everything up to the horizon on the sides it reaches.
    if (above < 4 || distance == 0) {
      if (low_tangent <= 0) low = -1;
      if (high_tangent >= 0) high = 1;
    }
    low -= kKeyMargin, high += kKeyMargin;
  }
  bool Empty() const { return low > high; }
};

}  // namespace

const std::vector<Part>& Gatherer::Gather(const Receiver& receiver) {
  parts_.clear();
  heap_.clear();
  intervals_.assign(1, {-1, kInfinity});
  if (!bvh_.nodes().empty()) Push(0, bvh_.bounds(), receiver);
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end());
    const Entry entry = heap_.back();
    heap_.pop_back();
    // What was found since it was pushed may hide it by now.
    if (Hidden(entry.low, entry.high, entry.distance)) continue;
    const BvhNode& node = bvh_.nodes()[entry.node];
    for (int lane = 0; lane < node.count; ++lane) {
      const auto child = node.first + static_cast<std::uint32_t>(lane);
      if (node.kind == BvhNode::Kind::kInner) {
        Push(child, node.BoxOfLane(lane), receiver);
      } else {
        AddElement(bvh_.slots()[child].element, receiver);
      }
    }
  }
  return parts_;
}

void Gatherer::Push(std::uint32_t node, const Box& box, const Receiver& receiver) {
  ++tests_;
  const BoxView view(box, receiver);
  if (view.Empty() || Hidden(view.low, view.high, view.distance)) return;
  heap_.push_back({view.distance, view.low, view.high, node});
  std::push_heap(heap_.begin(), heap_.end());
}

void Gatherer::AddElement(std::uint32_t element, const Receiver& receiver) {
  ++tests_;
  const BoxView view(BoxOf(scene_.elements()[element], 0), receiver);
  if (view.Empty() || Hidden(view.low, view.high, view.distance)) return;
  const Parts parts = PartsOf(scene_, static_cast<ElementId>(element), receiver);
  for (int i = 0; i < parts.count; ++i) {
    parts_.push_back(parts.part[i]);
    Cover(parts.part[i], receiver);
  }
}

std::size_t Gatherer::IntervalAt(double key) const {
  const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), key,
                                      [](double k, const Interval& interval) { return k < interval.low; });
  return after == intervals_.begin() ? 0 : static_cast<std::size_t>(after - intervals_.begin()) - 1;
}

bool Gatherer::Hidden(double low, double high, double distance) const {
  const double nearest = distance * (1 - kDepthMargin) - kLengthMargin;
  for (std::size_t i = IntervalAt(low); i < intervals_.size() && intervals_[i].low <= high; ++i)
    if (!(intervals_[i].depth < nearest)) return false;
  return true;
}

void Gatherer::Cover(const Part& part, const Receiver& receiver) {
  const double low = std::min(part.first.key, part.last.key) + kKeyMargin;
  const double high = std::max(part.first.key, part.last.key) - kKeyMargin;
  if (!(low < high)) return;
  const Element& element = scene_.element(part.element);
  const auto distance_at = [&](double key) {
    const UnitDirection direction(key);
    return DistanceAlong(element, part, receiver, direction.tangent, direction.normal);
  };
  // Between two directions a straight or hollow-free part is no farther than at the farther end; a hollow one may be,
  // by no more than its own size.
  const double bulge = part.kind == Part::Kind::kConcave ? element.length : 0;
  const std::size_t begin = IntervalAt(low);
  scratch_.clear();
  std::size_t i = begin;
  double from = low;
  double distance_from = distance_at(low);
  for (; i < intervals_.size() && intervals_[i].low < high; ++i) {
    const double to = i + 1 < intervals_.size() ? std::min(high, intervals_[i + 1].low) : high;
    const double distance_to = distance_at(to);
    if (intervals_[i].low < from) scratch_.push_back({intervals_[i].low, intervals_[i].depth});
    scratch_.push_back({from, std::min(intervals_[i].depth, std::max(distance_from, distance_to) + bulge)});
    if (to == high && (i + 1 == intervals_.size() || high < intervals_[i + 1].low))
      scratch_.push_back({high, intervals_[i].depth});
    from = to, distance_from = distance_to;
  }
  const auto first = intervals_.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = intervals_.begin() + static_cast<std::ptrdiff_t>(i);
  const std::size_t replaced = i - begin;
  if (scratch_.size() <= replaced) {
    std::copy(scratch_.begin(), scratch_.end(), first);
    intervals_.erase(first + static_cast<std::ptrdiff_t>(scratch_.size()), last);
  } else {
    std::copy(scratch_.begin(), scratch_.begin() + static_cast<std::ptrdiff_t>(replaced), first);
    intervals_.insert(last, scratch_.begin() + static_cast<std::ptrdiff_t>(replaced), scratch_.end());
  }
}

}  // namespace flatlight
