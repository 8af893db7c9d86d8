// SPDX-License-Identifier: Apache-2.0
// Pictures of direct light in closed form, against closed forms, quadrature and light tracing.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "core/render/skips.h"
#include "tests/support/transport/honest_errors.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

Settings Exact() {
  Settings settings;
  settings.method = Method::kExact;
  return settings;
}

struct Box {
  Point2 low, high;
};

// Gauss' rule of two points in each of many cells.
double MeanOver(const Box& box, const std::function<double(Point2)>& f) {
  constexpr int kCells = 40;
  const Vector2 cell{(box.high.x - box.low.x) / kCells, (box.high.y - box.low.y) / kCells};
  const double node = 0.5 / std::sqrt(3.0);
  double sum = 0;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      for (const double x : {-node, node})
        for (const double y : {-node, node})
          sum += 0.25 * f(box.low + Vector2{(i + 0.5 + x) * cell.x, (j + 0.5 + y) * cell.y});
    }
  }
  return sum / (kCells * kCells);
}

// Every pixel lies within its stated error of the truth, and that is small: relative to the picture's mean, in the
// worst pixel and (root of the mean square) in all.
void ExpectPicture(SceneMaker maker, const Box& box, std::uint32_t width, std::uint32_t height,
                   const std::function<double(const Box&)>& truth, double worst, double typical) {
  const auto scene = maker.Picture(box.low, box.high, width, height).Build();
  const ProbeField field = Render(scene, Exact()).field->probes.back();
  ASSERT_EQ(field.irradiance.size(), std::size_t{width} * height);
  ASSERT_EQ(field.irradiance_error.size(), field.irradiance.size());
  EXPECT_TRUE(field.standard_error.empty());
  const Vector2 pixel{(box.high.x - box.low.x) / width, (box.high.y - box.low.y) / height};
  double mean = 0, largest = 0, squares = 0;
  for (std::size_t i = 0; i < field.irradiance.size(); ++i) {
    const Point2 low =
        box.low + Vector2{static_cast<double>(i % width) * pixel.x, static_cast<double>(i / width) * pixel.y};
    const double expected = truth({low, low + pixel});
    const double error = field.irradiance_error[i];
    EXPECT_NEAR(field.irradiance[i], expected, error + 1e-9 * expected) << i;
    EXPECT_FALSE(std::abs(1.02 * field.irradiance[i] - expected) < error && expected > 0 && error < 0.005 * expected);
    mean += field.irradiance[i] / static_cast<double>(field.irradiance.size());
    largest = std::max(largest, error);
    squares += error * error / static_cast<double>(field.irradiance.size());
  }
  EXPECT_LT(largest, worst * mean);
  EXPECT_LT(std::sqrt(squares), typical * mean);
}

// The integral of 1/r over [0, x] x [0, y].
double InverseDistance(double x, double y) {
  return x == 0 || y == 0 ? 0 : x * std::asinh(y / std::abs(x)) + y * std::asinh(x / std::abs(y));
}

// The light stands in the middle of a pixel, on a corner of four, or beside them.
TEST(ExactPictureTest, PointLight) {
  SceneMaker maker;
  maker.Light(PointLightDescription{{0.2, 0.1}, {3 * kFullTurn}});
  const auto truth = [](const Box& box) {
    const Vector2 a = box.low - Point2{0.2, 0.1}, b = box.high - Point2{0.2, 0.1};
    return 3 *
           (InverseDistance(b.x, b.y) - InverseDistance(a.x, b.y) - InverseDistance(b.x, a.y) +
            InverseDistance(a.x, a.y)) /
           ((b.x - a.x) * (b.y - a.y));
  };
  ExpectPicture(maker, {{-0.8, -0.9}, {1.2, 1.1}}, 21, 21, truth, 0.01, 0.002);
  ExpectPicture(maker, {{-0.8, -0.9}, {1.2, 1.1}}, 20, 20, truth, 0.01, 0.002);
  ExpectPicture(maker, {{0.3, 0.5}, {0.9, 0.7}}, 7, 3, truth, 0.002, 0.001);
}

TEST(ExactPictureTest, SpotFades) {
  SceneMaker maker;
  maker.Light(SpotLightDescription{{0, 0}, {1, 0}, {3 * 0.8}, 0.1, 0.7});
  const auto f = [](Point2 p) {
    const double t = std::clamp((0.7 - std::abs(std::atan2(p.y, p.x))) / 0.6, 0.0, 1.0);
    return 3 * t * t * (3 - 2 * t) / std::hypot(p.x, p.y);
  };
  ExpectPicture(
      maker, {{0.5, -1}, {1.5, 1}}, 10, 20, [&](const Box& box) { return MeanOver(box, f); }, 0.01, 0.002);
}

TEST(ExactPictureTest, GlowingDisc) {
  SceneMaker maker;
  maker.Arc("disc", {{0, 0}, 0.3, 0, -kFullTurn}, {.radiance = {2}});
  const auto f = [](Point2 p) { return 4 * std::asin(0.3 / std::hypot(p.x, p.y)); };
  ExpectPicture(
      maker, {{0.3, -0.1}, {1.1, 0.7}}, 16, 16, [&](const Box& box) { return MeanOver(box, f); }, 0.01, 0.002);
}

TEST(ExactPictureTest, SkyBesideAWall) {
  SceneMaker maker;
  maker.Environment({2}).Segment("wall", {1, -1}, {1, 1});
  const auto f = [](Point2 p) { return 2 * (kFullTurn - std::atan2(1 - p.y, 1 - p.x) - std::atan2(1 + p.y, 1 - p.x)); };
  // The wall lies on the picture's border.
  ExpectPicture(
      maker, {{0, -1.5}, {1, 1.5}}, 10, 30, [&](const Box& box) { return MeanOver(box, f); }, 0.01, 0.002);
}

// A shadow's hard edge, x = y, runs through the pixels, and so does the wall that casts it.
TEST(ExactPictureTest, HardShadow) {
  SceneMaker maker;
  maker.Light(DirectionalLightDescription{{1, 1}, {5}}).Segment("wall", {0, 0}, {0.9, -0.9});
  const auto truth = [](const Box& box) {
    // Lit where y > x, behind the wall (x + y > 0).
    const double side = box.high.x - box.low.x, above = (box.low.y - box.low.x) / side;
    return 5 * (above >= 1    ? 1
                : above <= -1 ? 0
                : above >= 0  ? 1 - 0.5 * (1 - above) * (1 - above)
                              : 0.5 * (1 + above) * (1 + above));
  };
  ExpectPicture(maker, {{0.5, 0.43}, {1.2, 1.13}}, 7, 7, truth, 0.06, 0.025);
}

TEST(ExactPictureTest, ColoursAreApart) {
  SceneMaker maker;
  maker.Segment("left", {-1, 1}, {-1, -1}, {.radiance = {1, 0, 3}});
  maker.Segment("right", {1, -1}, {1, 1}, {.radiance = {0, 2, 0}});
  const auto scene = maker.Picture({-0.1, -0.1}, {0.1, 0.1}, 4, 4).Build();
  const ProbeField field = Render(scene, Exact()).field->probes.back();
  ASSERT_EQ(field.irradiance.size(), 48u);
  // The first pixel, from its middle; fluence is harmonic there.
  const auto angle = [](double distance) { return std::atan(1.075 / distance) + std::atan(0.925 / distance); };
  EXPECT_NEAR(field.irradiance[0], angle(0.925), 1e-6);
  EXPECT_NEAR(field.irradiance[1], 2 * angle(1.075), 1e-6);
  EXPECT_NEAR(field.irradiance[2], 3 * angle(0.925), 1e-6);
}

// What light tracing finds differs by its own noise alone.
TEST(ExactPictureTest, AgreesWithLightTracing) {
  SceneMaker maker;
  maker.Polyline("room", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true);
  maker.Arc("lamp", {{-0.6, 0.55}, 0.13, 0, -kFullTurn}, {.radiance = {1}});
  maker.Segment("panel", {0.9, -0.5}, {0.7, 0.8}, {.radiance = {2}, .two_sided = true});
  maker.Arc("bowl", {{0.1, -0.2}, 0.3, 0.3, 2.5}).Segment("post", {-0.31, -0.8}, {-0.25, 0.2});
  maker.Light(PointLightDescription{{0.23, 0.61}, {1}});
  const auto scene = maker.Picture({-1.1, -1.1}, {1.1, 1.1}, 40, 40).Build();
  const ProbeField exact = Render(scene, Exact()).field->probes[0];
  HonestErrors errors, wrong;
  const ProbeField traced = Render(scene, Sampled(64)).field->probes[0];
  for (std::size_t i = 0; i < exact.irradiance.size(); ++i) {
    // Where the error is not the traced one's alone, or where few paths come, statistics say little.
    if (exact.irradiance_error[i] > 0.1 * traced.standard_error[i]) continue;
    if (exact.irradiance[i] < 0.3) continue;
    errors.Add(traced.irradiance[i], exact.irradiance[i], traced.standard_error[i]);
    wrong.Add(1.03 * traced.irradiance[i], exact.irradiance[i], traced.standard_error[i]);
  }
  EXPECT_GT(errors.count(), 700u);
  // Pixels share paths: half as many independent ones are assumed at least.
  EXPECT_LT(std::abs(errors.MeanZ()), 5 * std::sqrt(40.0 / static_cast<double>(errors.count())));
  EXPECT_NEAR(errors.MeanSquareZ(), 1, 0.3);
  EXPECT_GT(wrong.MeanSquareZ(), 2);
}

// Whether what is seen is found in triangles or in the tree.
TEST(ExactPictureTest, SameLightThroughTriangles) {
  SceneMaker maker = FurnishedRoom(true, 1);
  SceneDescription description = maker.Picture({0, 0}, {4, 3}, 40, 30).description();
  std::erase_if(description.curves,
                [](const CurveDescription& curve) { return std::holds_alternative<ArcDescription>(curve.shape); });
  description.probes.erase(description.probes.begin(), description.probes.end() - 1);
  Diagnostics diagnostics;
  const auto scene = BuildScene(description, diagnostics);
  ASSERT_NE(scene, nullptr);
  Settings settings = Exact();
  settings.max_bounces = 0;
  Plan plan = PlanFor(*scene, settings);
  ASSERT_TRUE(plan.triangles);
  ThreadPool pool(1);
  std::vector<ProbeField> fields;
  for (const bool triangles : {true, false}) {
    plan.triangles = triangles;
    const std::unique_ptr<Rendering> rendering = StartRendering(scene, plan);
    rendering->Advance(pool, Cancellation(), SteadyClock(), kForever);
    ASSERT_TRUE(rendering->done());
    fields.push_back(rendering->Snapshot()->probes.back());
  }
  double mean = 0;
  for (const double value : fields[0].irradiance) mean += value / static_cast<double>(fields[0].irradiance.size());
  for (std::size_t i = 0; i < fields[0].irradiance.size(); ++i)
    EXPECT_NEAR(fields[0].irradiance[i], fields[1].irradiance[i], 1e-9 * mean + fields[0].irradiance_error[i]);
}

TEST(ExactPictureTest, SameBitsForAnyThreadsAndSlices) {
  SceneMaker maker = FurnishedRoom(false, 3);
  const auto scene = maker.Picture({1, 1}, {2, 2}, 12, 9).Picture({3, 1}, {3.3, 1.2}, 3, 4).Build();
  Settings settings = Exact();
  settings.max_bounces = 0;
  const std::uint64_t one = HashOf(*Render(scene, settings).field);
  EXPECT_EQ(HashOf(*Render(scene, settings, 2).field), one);
  EXPECT_EQ(HashOf(*Render(scene, settings, 7, std::chrono::microseconds(50)).field), one);
  for (const std::string& name : SkipNames()) {
    settings.no_skip = {name};
    EXPECT_EQ(HashOf(*Render(scene, settings).field), one) << name;
  }
}

// A convex room blocks nothing between its walls, but what is shown lies on both sides of them.
TEST(ExactPictureTest, DarkBehindTheWalls) {
  SceneMaker maker = SquareRoom({.radiance = {1}}, 1);
  const auto scene = maker.Picture({1.5, -0.5}, {2.5, 0.5}, 3, 3).Build();
  EXPECT_FALSE(PlanFor(*scene, Exact()).Takes(skip::kVisibility));
  EXPECT_EQ(Render(scene, Exact()).field->probes.back().irradiance, std::vector<double>(9, 0.0));
}

TEST(ExactPictureTest, IsTheDefaultForDirectLight) {
  SceneMaker black = SquareRoom({.radiance = {1}}, 1), grey = SquareRoom({.reflectance = {0.5}, .radiance = {1}}, 1);
  const auto direct = black.Picture({-1, -1}, {1, 1}, 3, 3).Build();
  EXPECT_EQ(PlanFor(*direct, {}).settings.method, Method::kExact);
  Settings settings;
  settings.samples = 16;
  EXPECT_EQ(PlanFor(*direct, settings).settings.method, Method::kPathTracing);
  const auto reflecting = grey.Picture({-1, -1}, {1, 1}, 3, 3).Build();
  EXPECT_EQ(PlanFor(*reflecting, {}).settings.method, Method::kPathTracing);
  settings = {};
  settings.max_bounces = 0;
  EXPECT_EQ(PlanFor(*reflecting, settings).settings.method, Method::kExact);
  // Of one job: points and pictures, with derivatives of the points.
  EXPECT_EQ(PlanFor(*direct, {}).settings.derivatives, Derivatives::kHessian);
}

TEST(ExactPictureTest, PicturesHaveNoDerivatives) {
  SceneMaker maker;
  maker.Segment("lamp", {0, 0}, {1, 0}, {.radiance = {1}});
  const auto scene = maker.Picture({-1, -1}, {1, 1}, 3, 3).Build();
  EXPECT_EQ(PlanFor(*scene, {}).settings.derivatives, Derivatives::kNone);
  Settings settings;
  settings.derivatives = Derivatives::kGradient;
  Diagnostics diagnostics;
  EXPECT_FALSE(MakePlan(*scene, settings, diagnostics).has_value());
  ASSERT_EQ(diagnostics.count(), 1u);
  EXPECT_EQ(diagnostics.kept()[0].path, "settings.derivatives");
}

}  // namespace
}  // namespace flatlight
