// SPDX-License-Identifier: Apache-2.0
// Curves that touch the receiver, or one another: what is seen, and how well it is known.
#include "core/plane/exact/touching.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/scene/scene.h"
#include "tests/core/plane/exact/oracle.h"
#include "tests/core/plane/exact/test_scenes.h"

namespace flatlight {
namespace {

// A turn and a scale that no double carries out exactly.
struct Pose {
  double angle;
  double scale;
  Point2 At(double x, double y) const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {scale * (c * x - s * y), scale * (s * x + c * y)};
  }
};

const std::vector<Pose> kPoses{{0, 1}, {0.7, 1}, {2.1, 37.3}, {-1.3, 3e-5}};

// The middle of a floor from (-1, 0) to (1, 0), whose front is up; and a lamp 2 units above.
SceneDescription FloorAndLamp(const Pose& pose) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{pose.At(-1, 0), pose.At(1, 0)});
  AddCurve(scene, SegmentDescription{pose.At(1, 2), pose.At(-1, 2)}, 1);
  AddProbe(scene, 0, 1);
  return scene;
}

WorldValue SolveOnly(const SceneDescription& scene) { return Solve(*Build(scene), 0)[0]; }

TEST(TouchingTest, ACircleThatStandsOnTheReceiverHidesAll) {
  for (const Pose& pose : kPoses) {
    for (const double turn : {2 * std::numbers::pi, -2 * std::numbers::pi}) {
      for (const double radius : {0.05, 0.4, 0.9}) {
        SceneDescription scene = FloorAndLamp(pose);
        // The lower half turns its outer side to the floor: the front, if it runs clockwise.
        const double start = pose.angle + 0.3;
        AddCurve(scene, ArcDescription{pose.At(0, radius), pose.scale * radius, start, turn}, 0.5);
        EXPECT_NEAR(SolveOnly(scene).irradiance, turn < 0 ? 1 : 0, 1e-13) << pose.angle << " " << turn << " " << radius;
      }
    }
  }
}

// Just beyond, a circle that goes down from the place where it touches is out of sight.
TEST(TouchingTest, ACircleUnderTheReceiverHidesNothing) {
  for (const Pose& pose : kPoses) {
    SceneDescription scene = FloorAndLamp(pose);
    const double without = SolveOnly(scene).irradiance;
    AddCurve(scene, ArcDescription{pose.At(0, -0.4), pose.scale * 0.4, pose.angle + 1, 2 * std::numbers::pi}, 0.5);
    EXPECT_NEAR(SolveOnly(scene).irradiance, without, 1e-13) << pose.angle;
  }
}

// A dome that begins at the receiver and goes over what lies behind it is left behind; one that goes over what lies
// ahead shows its inside. Upright there, it is no farther off than rounding.
TEST(TouchingTest, ADomeThatBeginsAtTheReceiverIsSeenFromTheSideBeyond) {
  for (const Pose& pose : kPoses) {
    for (const double ahead : {1.0, -1.0}) {
      SceneDescription scene = EmptyScene();
      AddCurve(scene, SegmentDescription{pose.At(-1, 0), pose.At(1, 0)});
      // Half circles; both with the front inside, and the outside dark.
      const double start = pose.angle + (ahead > 0 ? std::numbers::pi : 0);
      AddCurve(scene, ArcDescription{pose.At(ahead * 0.25, 0), pose.scale * 0.25, start, -ahead * std::numbers::pi}, 1,
               true);
      AddProbe(scene, 0, 1);
      const WorldValue value = SolveOnly(scene);
      // Inside, everything above is dome. From outside the dome fills what lies behind its upright tangent.
      EXPECT_NEAR(value.irradiance, ahead > 0 ? 2 : 1, 1e-13) << pose.angle << " " << ahead;
      EXPECT_TRUE(std::isfinite(value.gradient) && value.gradient_error >= 0);
    }
  }
}

TEST(TouchingTest, ThePartOfACircleThatAnArcLeavesOutDoesNotMoveTheReceiver) {
  SceneDescription scene = FloorAndLamp({0, 1});
  // Its circle passes through the probe point, upright.
  AddCurve(scene, ArcDescription{{0.3, 0}, 0.3, 1.0, 1.1}, 0.7, true);
  const WorldValue value = SolveOnly(scene);
  const auto truth = Oracle(scene).OnCurve(0, 0.5, Side::kFront);
  ASSERT_TRUE(truth);
  EXPECT_LE(std::abs(value.irradiance - truth->irradiance), value.irradiance_error + 1e-15 * truth->size);
}

// Far from the origin coordinates are exact, but what its author had to round may be off by far more.
TEST(TouchingTest, FarAwayAWallThroughTheReceiverTouchesAsItDoesForRays) {
  const Point2 far{4096, 8192};
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{far.x - 0.001, far.y}, {far.x + 0.001, far.y}});
  // Upright, hardly to the right of the point: what counts is the light right of it.
  const double x = far.x + 9.1e-13;
  AddCurve(scene, SegmentDescription{{x, far.y - 0.0005}, {x, far.y + 0.25}}, 1);
  AddProbe(scene, 0, 1);
  EXPECT_NEAR(SolveOnly(scene).irradiance, 0, 1e-5);
}

TEST(MeetingTest, ShallowCrossingsAreBoundByTheAngle) {
  for (const double slope : {1e-2, 1e-4, 1e-6}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{{-1, -1}, {1, -1.1}});
    AddCurve(scene, SegmentDescription{{0.9, 0.1}, {-0.8, 0.1 + 1.7 * slope}}, 1);
    AddCurve(scene, SegmentDescription{{0.8, 0.1 + 0.6 * slope}, {-0.9, 0.1 + 0.9 * slope}}, 0.3);
    AddProbe(scene, 0, 5, Side::kFront);
    const auto values = Solve(*Build(scene), 0);
    const Oracle oracle(scene);
    for (std::size_t i = 0; i < 5; ++i) {
      const auto truth = oracle.OnCurve(0, (static_cast<double>(i) + 0.5) / 5, Side::kFront);
      ASSERT_TRUE(truth);
      EXPECT_LE(std::abs(values[i].irradiance - truth->irradiance), values[i].irradiance_error + 1e-15 * truth->size);
      EXPECT_LE(values[i].irradiance_error, 1e-13 + 3e-14 / slope);
    }
  }
}

// Which of two circles that touch is in front there depends on rounding for the square root of it.
TEST(MeetingTest, CirclesThatTouchAreBoundByTheRoot) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, SegmentDescription{{-1, -1}, {1, -1}});
  AddCurve(scene, ArcDescription{{0.1, 0.3}, 0.5, 1, 2 * std::numbers::pi}, 1, true);
  AddCurve(scene, ArcDescription{{0.1 + 0.06, 0.3 - 0.08}, 0.4, 1, 2 * std::numbers::pi}, 0.3, true);
  AddProbe(scene, 0, 6);
  const auto values = Solve(*Build(scene), 0);
  const Oracle oracle(scene);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto truth = oracle.OnCurve(0, (static_cast<double>(i) + 0.5) / 6, Side::kFront);
    if (!truth) continue;
    EXPECT_LE(std::abs(values[i].irradiance - truth->irradiance), values[i].irradiance_error + 1e-15 * truth->size);
    EXPECT_LE(values[i].irradiance_error, 4e-6);
  }
}

}  // namespace
}  // namespace flatlight
