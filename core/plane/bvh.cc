// SPDX-License-Identifier: Apache-2.0
#include "core/plane/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace flatlight {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr std::size_t kBins = 16;

Point2 Middle(const Box& box) { return {0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y)}; }

double Along(Point2 p, int axis) { return axis == 0 ? p.x : p.y; }

}  // namespace

void Box::Add(Point2 p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y)};
}

void Box::Add(const Box& box) {
  low = {std::min(low.x, box.low.x), std::min(low.y, box.low.y)};
  high = {std::max(high.x, box.high.x), std::max(high.y, box.high.y)};
}

Box BoxOf(const Element& element, double margin) {
  Box box;
  box.Add(element.a);
  box.Add(element.b);
  if (element.kind == Element::Kind::kArc) {
    // An arc of at most a quarter lies in the triangle of its ends and the point where its end tangents meet, and
    // bulges from the chord by no more than half of it.
    const Vector2 chord = element.b - element.a;
    const Vector2 outward = element.Orientation() * Right(chord);
    const double bulge = 0.5 * Length(chord);
    const Vector2 offset = bulge / Length(chord) * outward;
    const double cos_half = Dot(element.radial_a, Normalized(element.radial_a + element.radial_b));
    const Vector2 sagitta = std::min(bulge, element.radius * (1 - cos_half) * (1 + 1e-9) + 1e-15) / bulge * offset;
    box.Add(element.a + sagitta);
    box.Add(element.b + sagitta);
  }
  return {box.low - Vector2{margin, margin}, box.high + Vector2{margin, margin}};
}

Bvh::Bvh(const Scene& scene) {
  const std::vector<Element>& elements = scene.elements();
  if (elements.empty()) return;
  const std::uint32_t count = static_cast<std::uint32_t>(elements.size());
  std::vector<Box> boxes(count);
  for (std::uint32_t i = 0; i < count; ++i) boxes[i] = BoxOf(elements[i], 2 * scene.touch_distance());
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(2 * elements.size());
  nodes_.push_back({{}, 0, count});

  struct Task {
    std::uint32_t node;
    int depth;
  };
  std::vector<Task> tasks{{0, 0}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    Node& node = nodes_[task.node];
    const auto begin = order_.begin() + node.first;
    const auto end = begin + node.count;
    Box middles;
    for (auto it = begin; it != end; ++it) {
      node.box.Add(boxes[*it]);
      middles.Add(Middle(boxes[*it]));
    }
    if (node.count <= kLeafSize) continue;

    // The split with the least surface area cost (MacDonald and Booth 1990), over bins of equal width (Wald 2007).
    const int axis = middles.high.x - middles.low.x >= middles.high.y - middles.low.y ? 0 : 1;
    const double low = Along(middles.low, axis);
    const double width = Along(middles.high, axis) - low;
    const auto bin_of = [&](std::uint32_t i) {
      return std::min(kBins - 1, static_cast<std::size_t>((Along(Middle(boxes[i]), axis) - low) / width * kBins));
    };
    auto middle = begin + node.count / 2;
    if (width > 0 && task.depth < kMaxDepth / 2) {
      std::array<Box, kBins> bin;
      std::array<std::uint32_t, kBins> filled{};
      for (auto it = begin; it != end; ++it) {
        bin[bin_of(*it)].Add(boxes[*it]);
        ++filled[bin_of(*it)];
      }
      std::array<double, kBins> right_cost{};
      Box right;
      std::uint32_t right_count = 0;
      for (std::size_t b = kBins - 1; b > 0; --b) {
        right.Add(bin[b]);
        right_count += filled[b];
        right_cost[b] = right_count == 0 ? 0 : right.HalfPerimeter() * right_count;
      }
      Box left;
      std::uint32_t left_count = 0;
      double best = std::numeric_limits<double>::infinity();
      std::size_t split = 0;
      for (std::size_t b = 0; b + 1 < kBins; ++b) {
        left.Add(bin[b]);
        left_count += filled[b];
        if (left_count == 0 || left_count == node.count) continue;
        const double cost = left.HalfPerimeter() * left_count + right_cost[b + 1];
        if (cost < best) best = cost, split = b + 1;
      }
      middle = std::partition(begin, end, [&](std::uint32_t i) { return bin_of(i) < split; });
    } else {
      // All in one place, or too deep: halves by order keep the depth bounded.
      std::nth_element(begin, middle, end, [&](std::uint32_t l, std::uint32_t r) {
        return Along(Middle(boxes[l]), axis) < Along(Middle(boxes[r]), axis);
      });
    }
    const std::uint32_t first = node.first;
    const std::uint32_t left_count = static_cast<std::uint32_t>(middle - begin);
    const std::uint32_t right_count = node.count - left_count;
    const std::uint32_t children = static_cast<std::uint32_t>(nodes_.size());
    node.first = children;
    node.count = 0;
    nodes_.push_back({{}, first, left_count});
    nodes_.push_back({{}, first + left_count, right_count});
    tasks.push_back({children, task.depth + 1});
    tasks.push_back({children + 1, task.depth + 1});
  }
}

}  // namespace flatlight
