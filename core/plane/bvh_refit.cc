// SPDX-License-Identifier: Apache-2.0
// The tree of an edited scene.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/plane/bvh.h"
#include "core/plane/lane_writer.h"

namespace flatlight {
namespace {

// Beyond this share a new tree is better, and not much slower to get.
constexpr double kMostChanged = 0.25;
// So much larger boxes may be, in all, than when they were built.
constexpr double kMostGrown = 1.5;

bool SamePlace(const Element& l, const Element& r) {
  return l.a == r.a && l.b == r.b && l.center == r.center && l.radius == r.radius && l.radial_a == r.radial_a &&
         l.radial_b == r.radial_b && l.sweep_angle == r.sweep_angle;
}

bool Encloses(const Box& outer, const Box& inner) {
  return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.high.x >= inner.high.x &&
         outer.high.y >= inner.high.y;
}

}  // namespace

std::optional<Bvh> Bvh::Refit(const Scene& before, const Scene& after) const {
  const std::size_t size = after.elements().size();
  if (size == 0 || before.elements().size() != size || before.touch_distance() != after.touch_distance()) {
    return std::nullopt;
  }
  std::vector<char> changed(size);
  std::size_t count = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const Element &old_element = before.elements()[i], &element = after.elements()[i];
    if (old_element.kind != element.kind || old_element.carrier != element.carrier) return std::nullopt;
    changed[i] = SamePlace(old_element, element) ? 0 : 1;
    count += static_cast<std::size_t>(changed[i]);
  }
  if (static_cast<double>(count) > kMostChanged * static_cast<double>(size)) return std::nullopt;
  Bvh refitted = *this;
  if (count > 0 && !refitted.RefitNodes(after, changed)) return std::nullopt;
  return refitted;
}

bool Bvh::RefitNodes(const Scene& scene, const std::vector<char>& changed) {
  // Children come after their parents. A node that did not change keeps the box that its parent had for it.
  std::vector<Box> boxes(nodes_.size());
  std::vector<std::uint32_t> frame_of(nodes_.size(), 0);
  boxes[0] = bounds_;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const BvhNode& node = nodes_[n];
    if (node.kind == BvhNode::Kind::kFrame) {
      boxes[node.first] = boxes[n];
      frame_of[node.first] = node.frame;
    } else if (node.kind == BvhNode::Kind::kInner) {
      for (int lane = 0; lane < node.count; ++lane) {
        boxes[node.first + static_cast<std::uint32_t>(lane)] = frames_[frame_of[n]].ToScene(node.BoxOfLane(lane));
        frame_of[node.first + static_cast<std::uint32_t>(lane)] = frame_of[n];
      }
    }
  }
  std::vector<char> touched(nodes_.size(), 0);
  double cost = 0;
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    BvhNode& node = nodes_[n];
    const auto in_lanes = [&](const auto& is_changed) {
      bool any = false;
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) any |= is_changed(i);
      return any;
    };
    if (node.kind == BvhNode::Kind::kFrame) {
      touched[n] = touched[node.first];
      boxes[n] = boxes[node.first];
    } else if (node.kind == BvhNode::Kind::kInner) {
      touched[n] = in_lanes([&](std::uint32_t child) { return touched[child] != 0; });
    } else {
      touched[n] = in_lanes([&](std::uint32_t slot) { return changed[slots_[slot].element] != 0; });
    }
    if (touched[n] != 0 && node.kind != BvhNode::Kind::kFrame && !RefitNode(scene, frame_of[n], boxes, n)) {
      return false;
    }
    cost += boxes[n].HalfPerimeter();
  }
  bounds_ = boxes[0];
  return cost <= kMostGrown * cost_;
}

bool Bvh::RefitNode(const Scene& scene, std::uint32_t frame_index, std::vector<Box>& boxes, std::size_t index) {
  BvhNode& node = nodes_[index];
  const BvhFrame& frame = frames_[frame_index];
  const auto box_of = [&](std::uint32_t lane) {
    if (node.kind == BvhNode::Kind::kInner) return boxes[node.first + lane];
    Slot& slot = slots_[node.first + lane];
    const Element& element = scene.elements()[slot.element];
    slot.a = element.a, slot.b = element.b;
    return BoxOf(element, 2 * scene.touch_distance());
  };
  std::vector<Box> lane_boxes;
  Box all;
  for (std::uint32_t lane = 0; lane < node.count; ++lane) {
    lane_boxes.push_back(box_of(lane));
    all.Add(lane_boxes.back());
  }
  boxes[index] = all;
  // A part with a frame of its own cannot grow out of it.
  const Vector2 half{frame.size, frame.size};
  if (frame_index != 0 && !Encloses({frame.center - half, frame.center + half}, all)) return false;
  LaneWriter lanes(frame, all, node);
  for (std::uint32_t lane = 0; lane < node.count; ++lane) {
    if (node.kind == BvhNode::Kind::kEnds) {
      lanes.SetEnds(lane, slots_[node.first + lane].a, slots_[node.first + lane].b);
    } else {
      lanes.SetBox(lane, lane_boxes[lane]);
    }
  }
  return true;
}

}  // namespace flatlight
