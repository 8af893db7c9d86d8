// SPDX-License-Identifier: Apache-2.0
// Light of lights without a surface over mirrors and glass, against images in mirrors, and against the ways found by
// scanning all directions of emission.
#include "core/plane/chains/chain_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "core/plane/materials/fresnel.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

// What chains bring to a place of the world, in its units.
class Chains {
 public:
  explicit Chains(SceneMaker maker, const ChainOptions& options = {})
      : scene_(maker.PointProbe({0.011, 0.022}, {0, 1}).Build()),
        caster_(scene_),
        chains_(caster_, options),
        most_links_(options.most_links) {}

  double Irradiance(Point2 world, Vector2 normal, ChainEffort effort = ChainEffort::kFine) const {
    double sum = 0;
    for (const ChainedLight& way : Find(world, normal, effort)) sum += way.light.cosine * way.light.irradiance[0];
    return sum * scene_->frame().radiance_scale;
  }
  std::vector<ChainedLight> Find(Point2 world, Vector2 normal, ChainEffort effort = ChainEffort::kFine) const {
    std::vector<ChainedLight> found;
    double rays = 0;
    chains_.Find(effort, At(world), normal, most_links_, rays, found);
    return found;
  }
  double IrradianceByChance(ChainEffort effort, Point2 world, Vector2 normal, double u) const {
    std::vector<ChainedLight> found;
    double rays = 0, sum = 0;
    chains_.FindByChance(effort, At(world), normal, most_links_, u, rays, found);
    for (const ChainedLight& way : found) sum += way.light.cosine * way.light.irradiance[0];
    return sum * scene_->frame().radiance_scale;
  }
  const ChainLights& lights() const { return chains_; }
  const Scene& scene() const { return *scene_; }

 private:
  SurfacePoint At(Point2 world) const {
    const Frame& frame = scene_->frame();
    return {Point2{} + (world - frame.origin) / frame.scale, ElementId::kNone};
  }

  std::shared_ptr<const Scene> scene_;
  RayCaster caster_;
  ChainLights chains_;
  std::uint32_t most_links_;
};

Look MirrorOf(double reflectance) {
  Look look;
  look.material = MirrorDescription{{reflectance}};
  return look;
}

Look Glass(double ior) {
  Look look;
  look.material = DielectricDescription{ior};
  return look;
}

// Irradiance from a point light of intensity 1.
double FromPoint(Point2 light, Point2 at, Vector2 normal) {
  const Vector2 way = light - at;
  return std::max(0.0, Dot(normal, way)) / LengthSquared(way);
}

TEST(ChainLightsTest, AMirrorShowsTheLightBehindIt) {
  SceneMaker maker;
  maker.Segment("mirror", {-1, 0}, {1, 0}, MirrorOf(0.7)).Light(PointLightDescription{{0.2, 0.5}, {kFullTurn}});
  const Chains chains(maker);
  const Vector2 up{0, 1}, down{0, -1};
  EXPECT_NEAR(chains.Irradiance({-0.4, 0.8}, down), 0.7 * FromPoint({0.2, -0.5}, {-0.4, 0.8}, down), 1e-13);
  EXPECT_EQ(chains.Irradiance({-0.4, 0.8}, up), 0);
  EXPECT_EQ(chains.Irradiance({-0.4, -0.8}, up), 0);
  // The mirror ends: from (0.2, -0.5) through (1, 0) the border of its light passes (2.6, 1).
  EXPECT_GT(chains.Irradiance({2.599, 1}, down), 0.01);
  EXPECT_EQ(chains.Irradiance({2.601, 1}, down), 0);
}

TEST(ChainLightsTest, BlockersStandInEveryLegOfTheWay) {
  for (const double x : {-0.8, 0.8}) {
    SceneMaker maker;
    maker.Segment("mirror", {-2, 0}, {2, 0}, MirrorOf(1)).Light(PointLightDescription{{-1, 1}, {kFullTurn}});
    maker.Segment("blocker", {x, 0.1}, {x, 2});
    EXPECT_EQ(Chains(maker).Irradiance({1, 1}, {0, -1}), 0) << x;
  }
  SceneMaker open;
  open.Segment("mirror", {-2, 0}, {2, 0}, MirrorOf(1)).Light(PointLightDescription{{-1, 1}, {kFullTurn}});
  open.Segment("blocker", {0.8, 0.81}, {0.8, 2});
  EXPECT_NEAR(Chains(open).Irradiance({1, 1}, {0, -1}), FromPoint({-1, -1}, {1, 1}, {0, -1}), 1e-13);
}

// Images in two mirrors that face each other, y = 0 and y = 1: at 2 k + y0 and 2 k - y0.
TEST(ChainLightsTest, TwoMirrorsShowARowOfLights) {
  const double rho = 0.6, y0 = 0.3;
  SceneMaker maker;
  maker.Segment("below", {-300, 0}, {300, 0}, MirrorOf(rho)).Segment("above", {-300, 1}, {300, 1}, MirrorOf(rho));
  maker.Light(PointLightDescription{{0, y0}, {kFullTurn}});
  const Point2 at{0.7, 0.45};
  for (const std::uint32_t most : {1u, 2u, 5u, 30u}) {
    double expected = 0;
    for (int k = -40; k <= 40; ++k) {
      const int even = 2 * std::abs(k), odd = std::abs(2 * k - 1);
      if (even > 0 && even <= static_cast<int>(most))
        expected += std::pow(rho, even) * FromPoint({0, 2.0 * k + y0}, at, {0, 1});
      if (odd <= static_cast<int>(most)) expected += std::pow(rho, odd) * FromPoint({0, 2.0 * k - y0}, at, {0, 1});
    }
    EXPECT_NEAR(Chains(maker, {.most_links = most}).Irradiance(at, {0, 1}), expected, 3e-7) << most;
  }
}

TEST(ChainLightsTest, SunOverAMirror) {
  SceneMaker maker;
  maker.Segment("mirror", {-1, 0}, {1, 0}, MirrorOf(0.5)).Light(DirectionalLightDescription{{0.6, -0.8}, {3}});
  const Chains chains(maker);
  EXPECT_NEAR(chains.Irradiance({0.3, 0.4}, {0, -1}), 0.5 * 3 * 0.8, 1e-13);
  EXPECT_EQ(chains.Irradiance({-1.1, 1}, {0, -1}), 0);
}

TEST(ChainLightsTest, SpotsFadeInMirrorsToo) {
  SceneMaker maker;
  maker.Segment("mirror", {-2, 0}, {2, 0}, MirrorOf(1));
  maker.Light(SpotLightDescription{{0, 1}, {0, -1}, {1}, 0.2, 0.6});
  const Chains chains(maker);
  const double intensity = 1 / (0.2 + 0.6);
  for (const double angle : {0.0, 0.1, 0.3, -0.5, 0.59, 0.61}) {
    const Point2 at{3 * std::tan(angle), 2};
    const double t = std::clamp((0.6 - std::abs(angle)) / 0.4, 0.0, 1.0);
    EXPECT_NEAR(chains.Irradiance(at, {0, -1}), intensity * t * t * (3 - 2 * t) * FromPoint({0, -1}, at, {0, -1}),
                1e-12);
  }
}

// A circle of a mirror around a light and a place: irradiance by scanning the mirror for places where it reflects
// one to the other (the difference of both angles changes its sign), and by how far rays beside that one miss.
double ByScanOfCircle(Point2 light, Point2 at, Vector2 normal) {
  const auto on_circle = [](double a) { return Point2{std::cos(a), std::sin(a)}; };
  const auto miss = [&](double a) {
    const Point2 q = on_circle(a);
    const Vector2 inward = Point2{} - q;
    const Vector2 in = Normalized(q - light);
    const Vector2 out = in - 2 * Dot(in, inward) * inward;
    return Cross(out, at - q);
  };
  constexpr int kSteps = 200000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    double low = kFullTurn * i / kSteps, high = kFullTurn * (i + 1) / kSteps;
    if ((miss(low) < 0) == (miss(high) < 0)) continue;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      ((miss(middle) < 0) == (miss(low) < 0) ? low : high) = middle;
    }
    const Point2 q = on_circle(low);
    const double cosine = Dot(normal, Normalized(q - at));
    if (!(cosine > 0)) continue;
    const double h = 1e-5;
    const double spread = std::abs(miss(low + h) - miss(low - h)) / (2 * h);
    const Vector2 way = q - light;
    const double angle = std::abs(Cross(way, Left(q - Point2{}))) / LengthSquared(way);
    sum += cosine * angle / spread;
  }
  return sum;
}

TEST(ChainLightsTest, AHollowMirrorHasUpToFourWays) {
  SceneMaker maker;
  maker.Arc("mirror", {{0, 0}, 1, 0.3, kFullTurn}, MirrorOf(1));
  maker.Light(PointLightDescription{{0.35, -0.2}, {kFullTurn}});
  const Chains chains(maker, {.most_links = 1});
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> uniform(-0.7, 0.7);
  std::size_t most = 0, least = 100;
  for (int i = 0; i < 40; ++i) {
    const Point2 at{uniform(engine), uniform(engine)};
    const Vector2 normal = Normalized(Vector2{uniform(engine), uniform(engine)});
    const std::size_t ways = chains.Find(at, normal).size() + chains.Find(at, -normal).size();
    most = std::max(most, ways), least = std::min(least, ways);
    const double expected = ByScanOfCircle({0.35, -0.2}, at, normal);
    EXPECT_NEAR(chains.Irradiance(at, normal), expected, 1e-6 * expected) << at.x << ' ' << at.y;
  }
  EXPECT_EQ(least, 2u);
  EXPECT_EQ(most, 4u);
}

TEST(ChainLightsTest, ARoundMirrorSpreadsLight) {
  SceneMaker maker;
  maker.Arc("ball", {{0, 0}, 0.5, 0, -kFullTurn}, MirrorOf(1));
  maker.Light(PointLightDescription{{-3, 0}, {kFullTurn}});
  const Chains chains(maker);
  // On the axis: intensity over the spread a light at distance d and a place at distance e see, with focal length R/2.
  const double d = 2.5, e = 1.7;
  EXPECT_NEAR(chains.Irradiance({-0.5 - e, 0}, {1, 0}), 1 / (d + e + 2 * d * e / 0.5), 1e-12);
  EXPECT_EQ(chains.Find({-0.5 - e, 0}, {1, 0}).size(), 1u);
  EXPECT_EQ(chains.Irradiance({3, 0}, {-1, 0}), 0);
}

// Through a slab, by the way's own equation: the ray's sine at which the sideways way is the wanted one.
TEST(ChainLightsTest, ASlabOfGlass) {
  const double ior = 1.5, thickness = 0.4;
  SceneMaker maker;
  maker.Segment("upper", {-50, 0}, {50, 0}, Glass(ior))
      .Segment("lower", {50, -thickness}, {-50, -thickness}, Glass(ior));
  maker.Light(PointLightDescription{{0, 0.5}, {kFullTurn}});
  const Chains chains(maker, {.least_share = 1e-9});
  EXPECT_LT(chains.lights().chance_share(ChainEffort::kFine), 1e-5);
  for (const double x : {0.0, 0.3, 1.7}) {
    const Point2 at{x, -1};
    double expected = 0;
    // Below the slab comes what was reflected 2 k times inside.
    for (int k = 0; k < 8; ++k) {
      const auto sideways = [&](double s) {
        const double inside = s / ior;
        return s / std::sqrt(1 - s * s) * (0.5 + 1 - thickness) +
               (2 * k + 1) * thickness * inside / std::sqrt(1 - inside * inside);
      };
      double low = 0, high = 1;
      for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (sideways(middle) < x ? low : high) = middle;
      }
      const double s = 0.5 * (low + high), c = std::sqrt(1 - s * s), inside = s / ior;
      // d(sideways)/d(angle), and irradiance = intensity over it.
      const double spread =
          (0.5 + 1 - thickness) / (c * c) + (2 * k + 1) * thickness / ior * c / std::pow(1 - inside * inside, 1.5);
      const double reflected = SplitAtBorder({s, c}, ior).reflected;
      expected += (1 - reflected) * (1 - reflected) * std::pow(reflected, 2 * k) / spread;
    }
    EXPECT_NEAR(chains.Irradiance(at, {0, 1}), expected, 2e-7 * expected) << x;
  }
}

// The flux of a light in a glass ball that comes to a circle around it. The light is nearer to the middle than R/n:
// nothing is reflected totally, and all comes out.
TEST(ChainLightsTest, FluxThroughAGlassBallIsKept) {
  SceneMaker maker;
  const Vector2 place{0.1, 0.2};
  maker.Arc("ball", {{0, 0}, 1, 0, -kFullTurn}, Glass(1.5)).Light(PointLightDescription{Point2{} + place, {1}});
  constexpr int kPoints = 2000;
  double straight = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double a = kFullTurn * i / kPoints;
    const double sine = Cross(place, {std::cos(a), std::sin(a)});
    straight += (1 - SplitAtBorder({sine, std::sqrt(1 - sine * sine)}, 1 / 1.5).reflected) / kPoints;
  }
  const auto flux = [&](const Chains& chains) {
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
      const double a = kFullTurn * i / kPoints;
      const Vector2 outward{std::cos(a), std::sin(a)};
      sum += chains.Irradiance(Point2{} + 1.3 * outward, -outward) * kFullTurn * 1.3 / kPoints;
    }
    return sum;
  };
  EXPECT_NEAR(flux(Chains(maker, {.most_links = 1})), straight, 1e-12);
  // Reflected inside, it has caustics outside, over which the sum goes in steps.
  EXPECT_NEAR(flux(Chains(maker)), 1, 3e-4);
}

// What is left to chance has the mean of what more ways, found beforehand, bring: if none is followed beforehand, some
// are, or all are but not looked at everywhere.
TEST(ChainLightsTest, ChancesHaveTheRightMean) {
  SceneMaker maker;
  maker.Segment("below", {-3, 0}, {3, 0}, MirrorOf(0.6)).Segment("above", {-3, 1}, {3, 1}, MirrorOf(0.6));
  maker.Segment("pane", {0.5, 0.1}, {0.5, 0.9}, Glass(1.4)).Light(PointLightDescription{{0, 0.3}, {kFullTurn}});
  const Chains many(maker, {.most_links = 12, .most_coarse_beams = 0});
  const Chains some(maker, {.most_links = 12, .most_beams = 100, .most_coarse_beams = 0});
  const Chains few(maker, {.most_links = 12, .most_beams = 0});
  EXPECT_LT(many.lights().chance_share(ChainEffort::kFine), 1e-4);
  EXPECT_GT(few.lights().chance_share(ChainEffort::kFine), 0.5);
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int kSamples = 250000;
  for (const Chains* chains : {&few, &some, &many}) {
    const ChainEffort effort = chains == &few ? ChainEffort::kFine : ChainEffort::kCoarse;
    for (const Point2 at : {Point2{0.2, 0.45}, Point2{1.4, 0.8}}) {
      double sum = 0, squares = 0;
      for (int i = 0; i < kSamples; ++i) {
        const double value = chains->IrradianceByChance(effort, at, {0, 1}, uniform(engine));
        sum += value, squares += value * value;
      }
      const double mean = sum / kSamples;
      const double error = std::sqrt((squares / kSamples - mean * mean) / kSamples);
      const double expected = many.Irradiance(at, {0, 1}) - chains->Irradiance(at, {0, 1}, effort);
      // Missed by 1 seed in 16,000.
      EXPECT_NEAR(mean, expected, 4 * error + 1e-4 * expected) << at.x;
      EXPECT_LT(error, 0.1 * expected);
    }
  }
}

}  // namespace
}  // namespace flatlight
