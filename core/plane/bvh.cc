// SPDX-License-Identifier: Apache-2.0
#include "core/plane/bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/plane/lane_writer.h"

namespace flatlight {
namespace {

constexpr std::size_t kWidth = BvhNode::kWidth;
constexpr std::size_t kBins = 16;
// In smaller frames the rounding of doubles would show.
constexpr double kLeastFrame = 0x1p-28;

struct Item {
  Box box;
  std::uint32_t element = 0;

  // Twice the middle, of which only differences matter.
  Point2 Middle() const { return {box.low.x + box.high.x, box.low.y + box.high.y}; }
};
using Items = std::span<Item>;

double Along(Point2 p, int axis) { return axis == 0 ? p.x : p.y; }

// Items and what is known of them.
struct Group {
  Items items;
  Box box;
  Box middles;
};

// Leaves are tested whole.
double Leaves(std::size_t count) { return std::ceil(static_cast<double>(count) / kWidth); }

struct Bin {
  Box box;
  Box middles;
  std::size_t count = 0;

  void Add(const Bin& other) {
    box.Add(other.box);
    middles.Add(other.middles);
    count += other.count;
  }
  double Cost() const { return count == 0 ? 0 : box.HalfPerimeter() * Leaves(count); }
};

Bin BinOf(Items items) {
  Bin bin;
  for (const Item& item : items) {
    bin.box.Add(item.box);
    bin.middles.Add(item.Middle());
  }
  bin.count = items.size();
  return bin;
}

// Splits a group in two, of which it becomes the first: with the least surface area cost (MacDonald and Booth 1990),
// over bins of equal width along the longer axis (Wald 2007).
Group SplitOff(Group& group) {
  const Box& middles = group.middles;
  const int axis = middles.high.x - middles.low.x >= middles.high.y - middles.low.y ? 0 : 1;
  const double low = Along(middles.low, axis), width = Along(middles.high, axis) - low;
  const double bins_per_length = kBins / width;
  const auto bin_of = [&](const Item& item) {
    return std::min(kBins - 1, static_cast<std::size_t>((Along(item.Middle(), axis) - low) * bins_per_length));
  };
  std::array<Bin, kBins> bins;
  for (const Item& item : group.items) {
    Bin& bin = bins[bin_of(item)];
    bin.box.Add(item.box);
    bin.middles.Add(item.Middle());
    ++bin.count;
  }
  std::array<Bin, kBins> right;  // All from a bin on.
  right[kBins - 1] = bins[kBins - 1];
  for (std::size_t b = kBins - 1; b-- > 0;) {
    right[b] = right[b + 1];
    right[b].Add(bins[b]);
  }
  Bin left, best_left;
  double best = std::numeric_limits<double>::infinity();
  std::size_t split = 1;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    left.Add(bins[b]);
    if (left.count == 0 || right[b + 1].count == 0) continue;
    const double cost = left.Cost() + right[b + 1].Cost();
    if (cost < best) best = cost, split = b + 1, best_left = left;
  }
  std::partition(group.items.begin(), group.items.end(), [&](const Item& item) { return bin_of(item) < split; });
  const Group rest{group.items.subspan(best_left.count), right[split].box, right[split].middles};
  group = {group.items.first(best_left.count), best_left.box, best_left.middles};
  return rest;
}

// The same, in halves by number.
Group HalveOff(Group& group) {
  const int axis = group.box.high.x - group.box.low.x >= group.box.high.y - group.box.low.y ? 0 : 1;
  const std::size_t half = group.items.size() / 2;
  std::nth_element(group.items.begin(), group.items.begin() + static_cast<std::ptrdiff_t>(half), group.items.end(),
                   [axis](const Item& l, const Item& r) {
                     const double a = Along(l.Middle(), axis), b = Along(r.Middle(), axis);
                     return a != b ? a < b : l.element < r.element;
                   });
  const Items first = group.items.first(half), second = group.items.subspan(half);
  const Bin left = BinOf(first), right = BinOf(second);
  group = {first, left.box, left.middles};
  return {second, right.box, right.middles};
}

// At most eight groups: the one whose box is largest is split until there are eight, or none is too large for a leaf.
struct Groups {
  std::size_t count = 1;
  std::array<Group, kWidth> group;
};

Groups SplitIntoGroups(const Group& whole, bool balanced) {
  Groups groups;
  groups.group[0] = whole;
  while (groups.count < kWidth) {
    Group* largest = nullptr;
    for (std::size_t g = 0; g < groups.count; ++g) {
      Group& group = groups.group[g];
      if (group.items.size() <= kWidth) continue;
      const bool larger = largest == nullptr || (balanced ? group.items.size() > largest->items.size()
                                                          : group.box.HalfPerimeter() > largest->box.HalfPerimeter());
      if (larger) largest = &group;
    }
    if (largest == nullptr) break;
    const Box& middles = largest->middles;
    const bool apart = middles.high.x > middles.low.x || middles.high.y > middles.low.y;
    groups.group[groups.count++] = balanced || !apart ? HalveOff(*largest) : SplitOff(*largest);
  }
  return groups;
}

// The smallest frame of the box.
BvhFrame FrameOf(const Box& box) {
  BvhFrame frame;
  frame.center = {0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y)};
  const double half = std::max({box.high.x - frame.center.x, box.high.y - frame.center.y, 1e-300});
  int exponent = 0;
  std::frexp(half, &exponent);
  frame.size = std::ldexp(1, exponent);
  frame.inverse_size = 1 / frame.size;
  return frame;
}

}  // namespace

Bvh::Bvh(const Scene& scene) {
  const std::vector<Element>& elements = scene.elements();
  if (elements.empty()) return;
  std::vector<Item> all(elements.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = {BoxOf(elements[i], 2 * scene.touch_distance()), static_cast<std::uint32_t>(i)};
  }
  const Bin everything = BinOf(all);
  bounds_ = everything.box;
  cost_ = bounds_.HalfPerimeter();
  slots_.reserve(elements.size());
  nodes_.reserve(elements.size() / 4 + 1);
  nodes_.emplace_back();

  struct Task {
    std::uint32_t node;
    std::uint32_t frame;
    int depth;
    Group group;
  };
  std::vector<Task> tasks{{0, 0, 0, {all, everything.box, everything.middles}}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const Items items = task.group.items;
    const Box& box = task.group.box;
    const double extent = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
    BvhNode node;
    if (items.size() > kWidth && extent < BvhNode::kLeastExtent * frames_[task.frame].size && extent > kLeastFrame) {
      node.kind = BvhNode::Kind::kFrame;
      node.frame = static_cast<std::uint32_t>(frames_.size());
      node.first = static_cast<std::uint32_t>(nodes_.size());
      frames_.push_back(FrameOf(box));
      cost_ += box.HalfPerimeter();
      nodes_.emplace_back();
      tasks.push_back({node.first, node.frame, task.depth, task.group});
      nodes_[task.node] = node;
      continue;
    }
    LaneWriter lanes(frames_[task.frame], box, node);
    if (items.size() <= kWidth) {
      node.first = static_cast<std::uint32_t>(slots_.size());
      node.count = static_cast<std::uint8_t>(items.size());
      const bool straight = std::all_of(items.begin(), items.end(), [&](const Item& item) {
        return elements[item.element].kind == Element::Kind::kSegment;
      });
      node.kind = straight ? BvhNode::Kind::kEnds : BvhNode::Kind::kBoxes;
      for (std::size_t lane = 0; lane < items.size(); ++lane) {
        const Element& element = elements[items[lane].element];
        slots_.push_back({element.a, element.b, items[lane].element, element.carrier});
        if (straight) {
          lanes.SetEnds(lane, element.a, element.b);
        } else {
          lanes.SetBox(lane, items[lane].box);
        }
      }
    } else {
      // Halves by number keep the depth bounded: 11 levels of them hold any number of elements.
      const Groups groups = SplitIntoGroups(task.group, task.depth >= kMaxDepth - 12);
      node.first = static_cast<std::uint32_t>(nodes_.size());
      node.count = static_cast<std::uint8_t>(groups.count);
      nodes_.resize(nodes_.size() + groups.count);
      for (std::size_t lane = 0; lane < groups.count; ++lane) {
        lanes.SetBox(lane, groups.group[lane].box);
        cost_ += groups.group[lane].box.HalfPerimeter();
        tasks.push_back(
            {node.first + static_cast<std::uint32_t>(lane), task.frame, task.depth + 1, groups.group[lane]});
      }
    }
    nodes_[task.node] = node;
  }
}

}  // namespace flatlight
