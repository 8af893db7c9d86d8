// SPDX-License-Identifier: Apache-2.0
// Arcs whose radius is far larger than the scene: nearly straight, and no less there.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/tolerances.h"
#include "core/plane/intersect.h"
#include "core/plane/ray_caster.h"
#include "core/scene/element_frame.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

// Through a point, with its outward normal at an angle, of length 1.
ArcDescription Through(Point2 place, double angle, double radius) {
  const Point2 center = place - radius * Vector2{std::cos(angle), std::sin(angle)};
  return {center, radius, angle - 0.5 / radius, 1 / radius};
}

TEST(WideArcTest, NoRayPassesOne) {
  for (const double radius : {1e2, 1e5, 7e8}) {
    SceneMaker maker;
    maker.Arc("arc", Through({0, 0}, 1.8, radius));
    maker.PointProbe({0, 3}, {0, 1});
    const RayCaster caster(maker.Build());
    ASSERT_EQ(caster.scene().elements().size(), 1u);
    const Element& arc = caster.scene().elements()[0];
    for (int i = 0; i < 200; ++i) {
      const ElementFrame frame = FrameAt(arc, (i + 0.5) / 200);
      for (const double side : {0.25, -0.25}) {
        const SurfacePoint from{frame.position + side * frame.normal, ElementId::kNone};
        const auto hit = caster.ClosestHit(from, -side * frame.normal);
        ASSERT_TRUE(hit.has_value()) << radius << " " << i;
        EXPECT_NEAR(hit->distance, 1, 1e-12);
        EXPECT_FALSE(caster.Visible(from, {frame.position - side * frame.normal, ElementId::kNone}));
      }
    }
  }
}

// Where two cross, the place lies on both circles to the last digits, whichever is wider.
TEST(WideArcTest, CrossingsKeepTheirDigits) {
  for (const double one : {0.8, 1e3, 1e8}) {
    for (const double other : {0.8, 1e4, 3e8}) {
      SceneMaker maker;
      maker.Arc("one", Through({0.1, 0.2}, 0.7, one));
      maker.Arc("other", Through({0.1, 0.2}, -1.1, other));
      maker.PointProbe({0, 3}, {0, 1});
      const auto scene = maker.Build();
      int crossings = 0;
      for (const Element& e : scene->elements()) {
        for (const Element& f : scene->elements()) {
          if (e.curve == f.curve) continue;
          const ElementCrossings common = CrossElements(e, f, scene->touch_distance());
          crossings += common.count;
          for (int i = 0; i < common.count; ++i) {
            for (const Element* arc : {&e, &f}) {
              const Vector2 q = common.point[i] - arc->a;
              EXPECT_NEAR(Dot(q, arc->radial_a) + LengthSquared(q) / (2 * arc->radius), 0, 32 * kUnitRoundoff)
                  << one << " " << other;
            }
          }
        }
      }
      EXPECT_EQ(crossings, 2) << one << " " << other;  // One place, both ways round.
    }
  }
}

}  // namespace
}  // namespace flatlight
