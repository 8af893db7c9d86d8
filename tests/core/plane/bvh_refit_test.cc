// SPDX-License-Identifier: Apache-2.0
// A tree that follows a scene's edits holds what it should, and gives up when a new one would be better.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/plane/box.h"
#include "core/plane/bvh.h"
#include "tests/core/plane/random_curves.h"

namespace flatlight {
namespace {

// Every element is in the tree once, as it is in the scene, and in all boxes above it.
class TreeCheck {
 public:
  TreeCheck(const Bvh& bvh, const Scene& scene) : bvh_(bvh), scene_(scene), seen_(scene.elements().size(), 0) {
    CheckNode(0, 0, {bvh.bounds()});
    for (const int times : seen_) EXPECT_EQ(times, 1);
  }

 private:
  void CheckNode(std::uint32_t index, std::uint32_t frame, std::vector<Box> around) {
    const BvhNode& node = bvh_.nodes()[index];
    if (node.kind == BvhNode::Kind::kFrame) return CheckNode(node.first, node.frame, around);
    for (int lane = 0; lane < node.count; ++lane) {
      const std::uint32_t place = node.first + static_cast<std::uint32_t>(lane);
      std::vector<Box> boxes = around;
      if (node.kind != BvhNode::Kind::kEnds) boxes.push_back(bvh_.frames()[frame].ToScene(node.BoxOfLane(lane)));
      if (node.kind == BvhNode::Kind::kInner) {
        CheckNode(place, frame, boxes);
        continue;
      }
      const Bvh::Slot& slot = bvh_.slots()[place];
      const Element& element = scene_.elements()[slot.element];
      ++seen_[slot.element];
      EXPECT_TRUE(slot.a == element.a && slot.b == element.b && slot.carrier == element.carrier);
      const Box box = BoxOf(element, 0);
      for (const Box& outer : boxes) {
        EXPECT_TRUE(outer.low.x <= box.low.x && outer.low.y <= box.low.y && outer.high.x >= box.high.x &&
                    outer.high.y >= box.high.y);
      }
      if (node.kind != BvhNode::Kind::kEnds) continue;
      // The ends on the node's grid, to half a step.
      const BvhFrame& f = bvh_.frames()[frame];
      const Box ends = f.ToScene(node.BoxOfLane(lane));
      const double off = 0.51 * static_cast<double>(node.step) * f.size;
      EXPECT_NEAR(ends.low.x, element.a.x, off);
      EXPECT_NEAR(ends.low.y, element.a.y, off);
      EXPECT_NEAR(ends.high.x, element.b.x, off);
      EXPECT_NEAR(ends.high.y, element.b.y, off);
    }
  }

  const Bvh& bvh_;
  const Scene& scene_;
  std::vector<int> seen_;
};

TEST(BvhRefitTest, FollowsEdits) {
  Random random(1);
  for (const int count : {4, 60, 1000}) {
    SceneDescription description = Room(random, count, 0.1);
    std::shared_ptr<const Scene> scene = BuildWithProbe(description);
    Bvh bvh(*scene);
    TreeCheck(bvh, *scene);
    for (int edit = 0; edit < 10; ++edit) {
      for (int i = 0; i < 1 + count / 50; ++i) {
        const auto c = static_cast<std::size_t>(random.Uniform(1, count));
        Move(description.curves[c], 0.02 * random.Direction());
      }
      const auto after = BuildWithProbe(description);
      std::optional<Bvh> refitted = bvh.Refit(*scene, *after);
      ASSERT_TRUE(refitted) << count << " curves, edit " << edit;
      scene = after;
      bvh = std::move(*refitted);
      TreeCheck(bvh, *scene);
    }
  }
}

TEST(BvhRefitTest, FollowsEditsOfTinyCurves) {
  Random random(2);
  SceneDescription description = Room(random, 20, 0.2);
  for (int i = 0; i < 200; ++i) {
    const Point2 a = Point2{0.3, 0.2} + 1e-6 * (random.Point() - Point2{});
    AddCurve(description, SegmentDescription{a, a + 1e-7 * random.Direction()});
  }
  const auto scene = BuildWithProbe(description);
  const Bvh built(*scene);
  ASSERT_GT(built.frames().size(), 1u);
  Move(description.curves.back(), {2e-7, 1e-7});
  const auto near = BuildWithProbe(description);
  std::optional<Bvh> bvh = built.Refit(*scene, *near);
  ASSERT_TRUE(bvh);
  TreeCheck(*bvh, *near);
  // Far out of the cluster's own coordinates.
  Move(description.curves.back(), {0.1, 0});
  EXPECT_FALSE(built.Refit(*scene, *BuildWithProbe(description)));
}

TEST(BvhRefitTest, GivesUpWhenANewTreeIsBetter) {
  Random random(3);
  SceneDescription description = Room(random, 400, 0.02);
  const auto scene = BuildWithProbe(description);
  const Bvh built(*scene);
  SceneDescription shuffled = description;
  for (std::size_t c = 1; c < 90; ++c) Move(shuffled.curves[c], 0.8 * random.Direction());
  EXPECT_FALSE(built.Refit(*scene, *BuildWithProbe(shuffled))) << "boxes would span the room";
  SceneDescription shifted = description;
  for (std::size_t c = 1; c < 200; ++c) Move(shifted.curves[c], {1e-3, 0});
  EXPECT_FALSE(built.Refit(*scene, *BuildWithProbe(shifted))) << "half of the curves moved";
  SceneDescription more = description;
  AddCurve(more, SegmentDescription{{0, 0}, {0.1, 0}});
  EXPECT_FALSE(built.Refit(*scene, *BuildWithProbe(more))) << "another number of curves";
}

}  // namespace
}  // namespace flatlight
