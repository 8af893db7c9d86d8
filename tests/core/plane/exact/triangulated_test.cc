// SPDX-License-Identifier: Apache-2.0
// What is seen through triangles is what the tree finds; and few points are left to the tree.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "core/plane/bvh.h"
#include "core/plane/exact/exact.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/scene/element_frame.h"
#include "core/scene/scene.h"
#include "tests/core/plane/exact/oracle.h"
#include "tests/core/plane/exact/test_scenes.h"

namespace flatlight {
namespace {

struct Outcome {
  int points = 0;
  int undecided = 0;
  int smaller = 0;    // Points with a smaller bound than the tree's.
  int confirmed = 0;  // Of those, by the oracle.
  int equal = 0;      // Bit by bit, but for the bounds.
};

// Where the triangles' bound is the smaller one (the tree doubts more crossings), the oracle must agree with it.
void ConfirmBound(const Oracle& oracle, const Scene& scene, const Probe& probe, std::size_t i, const ExactValue& value,
                  Outcome& outcome, const std::string& what) {
  const Receiver& receiver = probe.receivers[i];
  std::optional<OracleValue> truth;
  if (probe.curve == CurveId::kNone) {
    truth = oracle.AtPoint(scene.ToWorld(receiver.position), receiver.normal);
  } else {
    const bool front = Dot(receiver.normal, FrontNormal(scene.element(receiver.element), receiver.position)) > 0;
    truth = oracle.OnCurve(static_cast<std::size_t>(probe.curve),
                           (static_cast<double>(i) + 0.5) / static_cast<double>(probe.receivers.size()),
                           front ? Side::kFront : Side::kBack);
  }
  if (!truth) return;
  ++outcome.confirmed;
  const double l = scene.frame().radiance_scale, k = scene.frame().scale;
  ASSERT_NEAR(value.irradiance[0] * l, truth->irradiance, value.irradiance_error[0] * l + 1e-15 * truth->size) << what;
  ASSERT_NEAR(value.gradient[0] * l / k, truth->gradient,
              value.gradient_error[0] * l / k + 1e-12 * (1 + std::abs(truth->gradient)))
      << what;
  ASSERT_NEAR(value.hessian[0] * l / k / k, truth->hessian,
              value.hessian_error[0] * l / k / k + 1e-9 * (1 + std::abs(truth->hessian)))
      << what;
}

void Compare(const SceneDescription& description, Outcome& outcome, const std::string& what) {
  const auto built = Build(description);
  const Scene& scene = *built;
  const Oracle oracle(description);
  const auto triangulation = Triangulation::Of(scene);
  ASSERT_TRUE(triangulation) << what;
  const Bvh bvh(scene);
  ExactSolver tree(scene, bvh, {});
  ExactSolver triangles(scene, bvh, {}, triangulation.get());
  for (const Probe& probe : scene.probes()) {
    for (std::size_t i = 0; i < probe.receivers.size(); ++i) {
      const Receiver& receiver = probe.receivers[i];
      const ExactValue a = tree.Evaluate(receiver), b = triangles.Evaluate(receiver);
      for (int c = 0; c < scene.channels(); ++c) {
        ASSERT_NEAR(a.irradiance[c], b.irradiance[c], a.irradiance_error[c] + b.irradiance_error[c]) << what;
        ASSERT_NEAR(a.gradient[c], b.gradient[c], a.gradient_error[c] + b.gradient_error[c]) << what;
        ASSERT_NEAR(a.hessian[c], b.hessian[c], a.hessian_error[c] + b.hessian_error[c]) << what;
      }
      if (b.irradiance_error[0] < a.irradiance_error[0]) {
        // The oracle is slow: some of them.
        if (outcome.smaller++ % 10 == 0) ConfirmBound(oracle, scene, probe, i, b, outcome, what);
      }
      ++outcome.points;
      outcome.equal += a.irradiance == b.irradiance && a.gradient == b.gradient && a.hessian == b.hessian ? 1 : 0;
    }
  }
  outcome.undecided += static_cast<int>(triangles.undecided());
}

void AddFreePoints(SceneDescription& scene, std::mt19937_64& random, int count) {
  ProbeDescription free;
  free.name = "free";
  for (int i = 0; i < count; ++i)
    free.points.push_back({Point2{} + 1.5 * (RandomPoint(random) - Point2{}), RandomPoint(random) - Point2{}});
  scene.probes.push_back(free);
}

TEST(TriangulatedTest, CurvesThatCrossShowTheSame) {
  std::mt19937_64 random(31);
  Outcome outcome;
  for (int round = 0; round < 60; ++round) {
    SceneDescription scene = EmptyScene();
    for (int i = 0; i < 10 + 5 * (round % 12); ++i) AddRandomCurve(scene, random, false);
    for (std::size_t curve = 0; curve < 5; ++curve) {
      AddProbe(scene, curve, 20, Side::kFront);
      AddProbe(scene, curve, 20, Side::kBack);
    }
    AddFreePoints(scene, random, 300);
    Compare(scene, outcome, "round " + std::to_string(round));
    if (HasFatalFailure()) return;
  }
  EXPECT_EQ(outcome.points, 60 * 500);
  EXPECT_EQ(outcome.undecided, 0);
  EXPECT_EQ(outcome.equal, outcome.points);
}

// Walls on the floor and on each other, to rounding: what every plan of a house is made of.
TEST(TriangulatedTest, WallsThatMeetToRoundingAreNative) {
  std::mt19937_64 random(32);
  Outcome outcome;
  for (int round = 0; round < 40; ++round) {
    SceneDescription scene = EmptyScene();
    const double turn = round == 0 ? 0 : Uniform(random, -3, 3);
    const Vector2 along{std::cos(turn), std::sin(turn)}, up = Left(along);
    const auto place = [&](double x, double y) { return Point2{} + x * along + y * up; };
    AddCurve(scene, SegmentDescription{place(-1, -0.5), place(1, -0.5)});
    AddCurve(scene, SegmentDescription{place(1, 0.5), place(-1, 0.5)}, 1);
    for (int i = 0; i < 12; ++i) {
      const double x = Uniform(random, -0.95, 0.95), height = Uniform(random, 0.05, 0.6);
      AddCurve(scene, SegmentDescription{place(x, -0.5), place(x, -0.5 + height)}, i % 3 == 0 ? 0.5 : 0, true);
      if (i % 2 == 0) {
        const double reach = Uniform(random, -0.1, 0.1);
        AddCurve(scene, SegmentDescription{place(x, -0.5 + 0.7 * height), place(x + reach, -0.5 + 0.9 * height)});
      }
    }
    AddProbe(scene, 0, 200);
    AddProbe(scene, 1, 100);
    for (std::size_t wall = 2; wall < 8; ++wall) AddProbe(scene, wall, 20, wall % 2 == 0 ? Side::kFront : Side::kBack);
    AddFreePoints(scene, random, 100);
    Compare(scene, outcome, "round " + std::to_string(round));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(outcome.confirmed, 0);
  EXPECT_LT(outcome.undecided, outcome.points / 200);
  EXPECT_GT(outcome.equal, outcome.points * 99 / 100);
}

// On a grid directions coincide: then it is the tree's turn, and its answer is given.
TEST(TriangulatedTest, EventsAreLeftToTheTree) {
  std::mt19937_64 random(33);
  Outcome outcome;
  for (int round = 0; round < 60; ++round) {
    SceneDescription scene = EmptyScene();
    const auto place = [&] {
      return Point2{static_cast<double>(random() % 17) / 8 - 1, static_cast<double>(random() % 17) / 8 - 1};
    };
    while (scene.curves.size() < 8) {
      const Point2 a = place(), b = place();
      if (a != b) AddCurve(scene, SegmentDescription{a, b}, random() % 2 == 0 ? 1.0 : 0, random() % 2 == 0);
    }
    ProbeDescription free;
    free.name = "free";
    for (int i = 0; i < 40; ++i)
      free.points.push_back({place() + Vector2{1.0 / 32, 1.0 / 64}, {static_cast<double>(random() % 5) - 2, 1}});
    scene.probes.push_back(free);
    Compare(scene, outcome, "round " + std::to_string(round));
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(outcome.confirmed, 0);
  EXPECT_GT(outcome.undecided, outcome.points / 1000);
  EXPECT_LT(outcome.undecided, outcome.points / 4);
}

// Two plates end in line with the point, or all but: up to the accuracy of coordinates that is an event.
TEST(TriangulatedTest, DirectionsThatCoincideAreUndecided) {
  for (const double off : {0.0, 0x1p-52, -0x1p-52, 0x1p-44, -0x1p-44}) {
    SceneDescription scene = EmptyScene();
    AddCurve(scene, SegmentDescription{{2, 1}, {-2, 1}}, 1);
    AddCurve(scene, SegmentDescription{{0.25, 0.25}, {0.5, 0.125}});
    AddCurve(scene, SegmentDescription{{0.5 + off, 0.5}, {0.125, 0.75}});
    Outcome outcome;
    Compare(WithFreePoint(scene, {0, 0}), outcome, std::to_string(off));
    EXPECT_EQ(outcome.undecided, std::abs(off) < 0x1p-50 ? 1 : 0) << off;
  }
}

TEST(TriangulatedTest, ColoursAreTheSame) {
  std::mt19937_64 random(34);
  SceneDescription scene = EmptyScene();
  for (int i = 0; i < 40; ++i) {
    AddRandomCurve(scene, random, false);
    if (i % 2 == 0)
      scene.curves.back().emission = EmissionDescription{{Uniform(random, 0, 1), 0, Uniform(random, 0, 1)}};
  }
  AddFreePoints(scene, random, 200);
  Outcome outcome;
  Compare(scene, outcome, "colours");
  EXPECT_EQ(outcome.equal, outcome.points);
}

TEST(TriangulatedTest, TheEnvironmentShinesBetweenTheWalls) {
  std::mt19937_64 random(35);
  Outcome outcome;
  for (int round = 0; round < 20; ++round) {
    SceneDescription scene = EmptyScene();
    for (int i = 0; i < 8; ++i) AddRandomCurve(scene, random, false);
    scene.environment = EnvironmentDescription{{0.25, 0.5, Uniform(random, 0, 1)}};
    AddProbe(scene, 0, 20, Side::kFront);
    AddProbe(scene, 1, 20, Side::kBack);
    AddFreePoints(scene, random, 60);
    Compare(scene, outcome, "round " + std::to_string(round));
    if (HasFatalFailure()) return;
  }
  EXPECT_EQ(outcome.undecided, 0);
  EXPECT_EQ(outcome.equal, outcome.points);
}

// Behind a grate each beam goes through the same triangles: then the tree is faster, and its answer is given.
TEST(TriangulatedTest, ManyBeamsAreLeftToTheTree) {
  SceneDescription scene = EmptyScene();
  constexpr int kSlits = 300;
  for (int i = 0; i < kSlits; ++i) {
    const double x = 2.0 * i / kSlits - 1;
    AddCurve(scene, SegmentDescription{{0.01 * x, 0.01}, {0.01 * x + 0.4 / (100 * kSlits), 0.01}});
    AddCurve(scene, SegmentDescription{{-1, 0.3 + 0.002 * i}, {-1, 0.301 + 0.002 * i}}, 1);
    AddCurve(scene, SegmentDescription{{1, 0.3001 + 0.002 * i}, {1, 0.3011 + 0.002 * i}}, 1, true);
  }
  AddCurve(scene, SegmentDescription{{1.1, 1}, {-1.1, 1}}, 1);
  Outcome outcome;
  Compare(WithFreePoint(scene, {0.0001, 0}), outcome, "grate");
  EXPECT_EQ(outcome.undecided, 1);
}

// Wherever the scene is and however large: as the tree has it, and as arithmetic in 113 bits has it.
TEST(TriangulatedTest, ScalesAndPlacesAgreeWithTheOracle) {
  std::mt19937_64 random(36);
  for (const double scale : {1e-9, 1.0, 1e9}) {
    for (const double away : {0.0, 1e3}) {
      int compared = 0;  // The oracle keeps away from events.
      for (int round = 0; round < 3; ++round) {
        SceneDescription scene = EmptyScene();
        const Point2 origin{away * scale, away * scale};  // Alike: the oracle steps by the spread of all coordinates.
        const auto place = [&](double x, double y) { return origin + scale * Vector2{x, y}; };
        const auto any = [&] { return place(Uniform(random, -1, 1), Uniform(random, -1, 1)); };
        // Walls that share ends, end on others to rounding, and cross.
        const Point2 corner = any(), next = any(), last = any();
        AddCurve(scene, SegmentDescription{corner, next}, 1);
        AddCurve(scene, SegmentDescription{next, last}, 0.5, true);
        AddCurve(scene, SegmentDescription{corner + 0.3 * (next - corner), any()});
        for (int i = 0; i < 4; ++i) AddCurve(scene, SegmentDescription{any(), any()}, i, i % 2 == 0);
        ProbeDescription free;
        free.name = "free";
        for (int i = 0; i < 12; ++i) {
          const double reach = i < 8 ? 1 : 3;  // Also outside all curves, and beyond the triangulation.
          free.points.push_back({place(Uniform(random, -reach, reach), Uniform(random, -reach, reach)),
                                 {Uniform(random, -1, 1), Uniform(random, -1, 1)}});
        }
        scene.probes.push_back(free);
        const auto built = Build(scene);
        const auto triangulation = Triangulation::Of(*built);
        ASSERT_TRUE(triangulation);
        const Oracle oracle(scene);
        const std::vector<WorldValue> values = Solve(*built, 0, triangulation.get()),
                                      others = Solve(*built, 0, nullptr);
        for (std::size_t i = 0; i < values.size(); ++i) {
          const auto truth = oracle.AtPoint(free.points[i].position, free.points[i].normal);
          if (!truth) continue;
          ++compared;
          const WorldValue &v = values[i], &tree = others[i];
          // Above the bounds: the oracle's own differences.
          const std::string where = std::to_string(scale) + " " + std::to_string(away) + " " + std::to_string(i);
          EXPECT_NEAR(v.irradiance, truth->irradiance, v.irradiance_error + 1e-15 * truth->size) << where;
          EXPECT_NEAR(v.gradient * scale, truth->gradient * scale, v.gradient_error * scale + 1e-12 * (1 + truth->size))
              << where;
          EXPECT_NEAR(v.hessian * scale * scale, truth->hessian * scale * scale,
                      v.hessian_error * scale * scale + 1e-9 * (1 + truth->size))
              << where;
          EXPECT_NEAR(v.irradiance, tree.irradiance, v.irradiance_error + tree.irradiance_error) << where;
        }
      }
      EXPECT_GT(compared, 12) << scale << " " << away;
    }
  }
}

// A point on an edge of the triangulation is nothing special.
TEST(TriangulatedTest, PointsOnEdgesOfTheTriangulationAreNative) {
  SceneDescription scene = EmptyScene();
  AddCurve(scene, PolylineDescription{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true}, 1);
  ProbeDescription free;
  free.name = "free";
  for (int i = -9; i <= 9; ++i) {
    if (i == 0) continue;
    for (const double sign : {-1.0, 1.0}) free.points.push_back({{i / 10.0, sign * i / 10.0}, {0.3, sign * 0.8}});
  }
  scene.probes.push_back(free);
  Outcome outcome;
  Compare(scene, outcome, "diagonals");
  EXPECT_EQ(outcome.undecided, 0);
  EXPECT_EQ(outcome.equal, outcome.points);
}

}  // namespace
}  // namespace flatlight
