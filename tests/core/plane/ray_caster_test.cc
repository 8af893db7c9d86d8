// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_caster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/scene/element_frame.h"
#include "tests/core/plane/random_curves.h"
#include "tests/support/transport/brute_rays.h"

namespace flatlight {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::shared_ptr<const Scene> Build(const SceneDescription& description) {
  auto scene = BuildWithProbe(description);
  EXPECT_TRUE(scene);
  return scene;
}

TEST(RayCasterTest, TreeAgreesWithBruteForce) {
  Random random(1);
  for (const int count : {1, 3, 20, 400}) {
    for (int round = 0; round < 10; ++round) {
      SceneDescription description;
      const double size = 2 / std::sqrt(count);
      for (int i = 0; i < count; ++i) {
        if (i % 3 == 0) {
          AddCurve(description, ArcDescription{random.Point(), random.Uniform(0.01, size), random.Uniform(-4, 4),
                                               random.Uniform(0.1, 6.2) * (i % 2 == 0 ? 1 : -1)});
        } else {
          const Point2 a = random.Point();
          AddCurve(description, SegmentDescription{a, a + size * random.Direction()});
        }
      }
      const auto scene = Build(description);
      const RayCaster caster(scene);
      for (int ray = 0; ray < 500; ++ray) {
        SurfacePoint from{random.Point(), ElementId::kNone};
        Vector2 direction = random.Uniform(0.1, 10) * random.Direction();
        if (ray % 2 == 0) {
          const auto e = static_cast<std::size_t>(random.Uniform(0, 1) * static_cast<double>(scene->elements().size()));
          from = {FrameAt(scene->elements()[e], random.Uniform(0, 1)).position, static_cast<ElementId>(e)};
        } else if (ray % 5 == 0) {
          direction = ray % 10 == 0 ? Vector2{1, 0} : Vector2{0, -1};
        }
        const auto expected = BruteClosestHit(*scene, from, direction);
        const auto hit = caster.ClosestHit(from, direction);
        ASSERT_EQ(hit.has_value(), expected.has_value());
        if (!hit) continue;
        const double distance = expected->distance;
        ASSERT_EQ(hit->distance, distance);
        ASSERT_EQ(hit->element, expected->element);
        // A point just before the hit is visible, the next curve's points behind are not.
        ASSERT_TRUE(caster.Visible(from, {from.position + distance * (1 - 1e-9) * direction, ElementId::kNone}));
        ASSERT_FALSE(caster.Visible(from, {from.position + distance * (1 + 1e-9) * direction, ElementId::kNone}));
        ASSERT_TRUE(caster.Visible(from, {hit->position, hit->element}));
      }
    }
  }
}

// A room of many pieces, seen from inside: no ray leaves, above all none aimed at the places where pieces meet.
void ExpectClosed(const SceneDescription& description, Point2 inside, const std::string& what) {
  const auto scene = Build(description);
  const RayCaster caster(scene);
  const Frame& frame = scene->frame();
  const Point2 from{(inside.x - frame.origin.x) / frame.scale, (inside.y - frame.origin.y) / frame.scale};
  Random random(5);
  for (const Element& element : scene->elements()) {
    for (const Point2 target : {element.a, element.b, FrameAt(element, 0.5).position}) {
      for (int i = 0; i < 40; ++i) {
        const double blur = i < 10 ? 0 : std::pow(10, random.Uniform(-17, -13));
        const Point2 origin = i % 2 == 0 ? from : from + 0.01 * Vector2{random.Uniform(-1, 1), random.Uniform(-1, 1)};
        const Vector2 direction = (target - origin) + blur * random.Direction();
        ASSERT_TRUE(caster.ClosestHit({origin, ElementId::kNone}, direction).has_value()) << what;
        ASSERT_FALSE(caster.Visible({origin, ElementId::kNone}, {origin + 1000 * direction, ElementId::kNone})) << what;
      }
    }
  }
}

TEST(RayCasterTest, NoLeakWhereCurvesMeetAtAnyScale) {
  Random random(2);
  for (const double scale : {1e-9, 1.0, 1e9}) {
    for (const double shift : {0.0, 1000.0}) {
      for (int round = 0; round < 10; ++round) {
        const Vector2 turn = random.Direction();
        const Point2 center{random.Uniform(-1, 1) + shift, random.Uniform(-1, 1) + shift};
        const auto place = [&](double x, double y) {
          return Point2{scale * (center.x + turn.x * x - turn.y * y), scale * (center.y + turn.y * x + turn.x * y)};
        };
        const std::string what = std::to_string(scale) + " " + std::to_string(shift);
        // Four walls that share corners.
        SceneDescription corners;
        AddCurve(corners, PolylineDescription{{place(-1, -1), place(1, -1), place(0.7, 1), place(-1.2, 0.9)}, true});
        ExpectClosed(corners, place(0, 0), "corners " + what);
        // Walls that end on the inside of others: T-junctions, to rounding.
        SceneDescription junctions;
        const double x1 = random.Uniform(0.1, 0.9), x2 = random.Uniform(-0.9, -0.1);
        AddCurve(junctions, SegmentDescription{place(-2, -1), place(2, -1.0)});
        AddCurve(junctions, SegmentDescription{place(-2, 1), place(2, 1)});
        AddCurve(junctions, SegmentDescription{place(x1, -1), place(x1 + 0.3, 1)});
        AddCurve(junctions, SegmentDescription{place(x2, 1), place(x2 - 0.2, -1)});
        const auto scene = Build(junctions);
        const RayCaster caster(scene);
        const Frame& frame = scene->frame();
        const auto normalised = [&](Point2 p) {
          return Point2{(p.x - frame.origin.x) / frame.scale, (p.y - frame.origin.y) / frame.scale};
        };
        // From one room along the floor, through where the wall stands on it, to the other room.
        for (const ElementId floor : {ElementId{0}, ElementId{1}}) {
          const Element& element = scene->element(floor);
          for (int i = 0; i < 50; ++i) {
            const double toward = floor == ElementId{0} ? x1 : x1 + 0.3;
            const double f = (toward + 2) / 4;
            const SurfacePoint left{FrameAt(element, f - random.Uniform(0.001, 0.05)).position, floor};
            const Point2 right = normalised(place(toward + random.Uniform(0.001, 0.5), floor == ElementId{0} ? -1 : 1));
            const Vector2 up = (floor == ElementId{0} ? 1 : -1) * std::pow(10, random.Uniform(-16.5, -14)) *
                               FrontNormal(element, right);
            ASSERT_FALSE(caster.Visible({left.position + up, ElementId::kNone}, {right + up, ElementId::kNone}))
                << what;
          }
        }
        // A circle of arcs that meet at computed ends, one of them a full turn's rest.
        SceneDescription arcs;
        const double start = random.Uniform(-3, 3), sweep = random.Uniform(0.5, 5);
        const Point2 middle = place(0, 0);
        AddCurve(arcs, ArcDescription{middle, scale, start, sweep});
        AddCurve(arcs, ArcDescription{middle, scale, start, sweep - 2 * kPi});
        ExpectClosed(arcs, place(0.1, 0.2), "arcs " + what);
        // A half circle closed by its diameter.
        SceneDescription half;
        AddCurve(half, ArcDescription{middle, scale, start, kPi});
        const Vector2 end{std::cos(start), std::sin(start)};
        AddCurve(half, SegmentDescription{middle + scale * end, middle - scale * end});
        ExpectClosed(half, middle + 0.3 * scale * Left(end), "half circle " + what);
        ExpectClosed(half, middle + 0.3 * scale * Left(end), "half circle " + what);
      }
    }
  }
}

TEST(RayCasterTest, AKeyholeStaysOpen) {
  for (const double gap : {1e-3, 1e-7, 1e-10}) {
    SceneDescription description;
    AddCurve(description, SegmentDescription{{-1, 0}, {-gap / 2, 0}});
    AddCurve(description, SegmentDescription{{gap / 2, 0}, {1, 0}});
    const RayCaster caster(Build(description));
    int through = 0;
    for (int i = 0; i < 1000; ++i) {
      const double x = (i + 0.5) / 1000 * 2 * gap - gap;
      through += caster.Visible({{x, -0.5}, ElementId::kNone}, {{x, 0.5}, ElementId::kNone}) ? 1 : 0;
    }
    EXPECT_NEAR(through, 500, 2 + 1000 * 1e-14 / gap) << gap;
  }
}

TEST(RayCasterTest, ARayLeavesItsOwnCurve) {
  SceneDescription description;
  AddCurve(description, ArcDescription{{0, 0}, 1, 0.2, 2 * kPi});
  AddCurve(description, SegmentDescription{{-3, -2}, {4, -1.5}});
  AddCurve(description, ArcDescription{{0, 1e6}, 1e6 + 3, -kPi / 2 - 1e-6, 2e-6});  // Nearly straight, radius 1e6.
  const auto scene = Build(description);
  const RayCaster caster(scene);
  Random random(9);
  for (std::uint32_t e = 0; e < scene->elements().size(); ++e) {
    const Element& element = scene->elements()[e];
    for (int i = 0; i < 2000; ++i) {
      const ElementFrame frame = FrameAt(element, random.Uniform(0, 1));
      const double sine = random.Uniform(-1, 1) * (1 - std::pow(10, random.Uniform(-12, -1)));
      const double side = i % 2 == 0 ? 1 : -1;
      const Vector2 direction = sine * frame.tangent + side * std::sqrt(1 - sine * sine) * frame.normal;
      const auto hit = caster.ClosestHit({frame.position, static_cast<ElementId>(e)}, direction);
      if (!hit) continue;
      const Element& other = scene->element(hit->element);
      if (other.carrier != element.carrier) continue;
      ASSERT_EQ(element.kind, Element::Kind::kArc);
      // A chord of the circle: twice the radius times the cosine.
      ASSERT_GT(side * element.Orientation(), 0) << "hit from outside";
      ASSERT_NEAR(hit->distance, 2 * element.radius * std::sqrt(1 - sine * sine), 1e-12 * element.radius);
    }
  }
}

TEST(RayCasterTest, ManyCurvesBuildAndTrace) {
  Random random(4);
  SceneDescription description;
  for (int i = 0; i < 200000; ++i) {
    const Point2 a = random.Point();
    AddCurve(description, SegmentDescription{a, a + 0.001 * random.Direction()});
  }
  const RayCaster caster(Build(description));
  for (int i = 0; i < 1000; ++i) {
    const Point2 origin{random.Uniform(-0.4, 0.4), random.Uniform(-0.4, 0.4)};
    EXPECT_TRUE(caster.ClosestHit({origin, ElementId::kNone}, random.Direction()));
  }
}

TEST(RayCasterTest, AnEmptySceneHasNoHits) {
  const RayCaster caster(Build(SceneDescription{}));
  EXPECT_FALSE(caster.ClosestHit({{0, 0}, ElementId::kNone}, {1, 0}).has_value());
  EXPECT_TRUE(caster.Visible({{0, 0}, ElementId::kNone}, {{1, 0}, ElementId::kNone}));
}

}  // namespace
}  // namespace flatlight
