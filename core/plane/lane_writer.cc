// SPDX-License-Identifier: Apache-2.0
#include "core/plane/lane_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace flatlight {
namespace {

std::uint8_t GridNumber(double value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)); }

}  // namespace

Box BvhNode::BoxOfLane(int lane) const {
  const double x = static_cast<double>(origin_x), y = static_cast<double>(origin_y), size = static_cast<double>(step);
  return {{x + low_x[lane] * size, y + low_y[lane] * size}, {x + high_x[lane] * size, y + high_y[lane] * size}};
}

LaneWriter::LaneWriter(const BvhFrame& frame, const Box& box, BvhNode& node) : node_(node), frame_(frame) {
  const Point2 low = ToFrame(box.low), high = ToFrame(box.high);
  const double extent = std::max({high.x - low.x, high.y - low.y, 0.5 * BvhNode::kLeastExtent});
  // A step for what is to spare, and half a step for rounding, on both sides.
  node.step = static_cast<float>(extent / 252);
  node.inverse_step = 1 / node.step;
  const double step = static_cast<double>(node.step);
  node.origin_x = static_cast<float>(low.x - 1.5 * step);
  node.origin_y = static_cast<float>(low.y - 1.5 * step);
}

void LaneWriter::SetBox(std::size_t lane, const Box& box) {
  const Point2 low = ToGrid(box.low), high = ToGrid(box.high);
  node_.low_x[lane] = GridNumber(std::floor(low.x - BvhNode::kSpareSteps));
  node_.low_y[lane] = GridNumber(std::floor(low.y - BvhNode::kSpareSteps));
  node_.high_x[lane] = GridNumber(std::ceil(high.x + BvhNode::kSpareSteps));
  node_.high_y[lane] = GridNumber(std::ceil(high.y + BvhNode::kSpareSteps));
}

void LaneWriter::SetEnds(std::size_t lane, Point2 a, Point2 b) {
  const Point2 grid_a = ToGrid(a), grid_b = ToGrid(b);
  node_.low_x[lane] = GridNumber(grid_a.x + 0.5);
  node_.low_y[lane] = GridNumber(grid_a.y + 0.5);
  node_.high_x[lane] = GridNumber(grid_b.x + 0.5);
  node_.high_y[lane] = GridNumber(grid_b.y + 0.5);
}

Point2 LaneWriter::ToFrame(Point2 p) const {
  return {(p.x - frame_.center.x) * frame_.inverse_size, (p.y - frame_.center.y) * frame_.inverse_size};
}

Point2 LaneWriter::ToGrid(Point2 p) const {
  const Point2 q = ToFrame(p);
  const double step = static_cast<double>(node_.step);
  return {(q.x - static_cast<double>(node_.origin_x)) / step, (q.y - static_cast<double>(node_.origin_y)) / step};
}

}  // namespace flatlight
