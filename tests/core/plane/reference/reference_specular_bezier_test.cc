// SPDX-License-Identifier: Apache-2.0
// Béziers beside mirrors and glass, and Béziers that are such, against scenes with the same light.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "core/scene/material.h"
#include "tests/support/transport/scene_maker.h"
#include "tests/support/transport/solve_reference.h"

namespace flatlight {
namespace {

ReferenceOptions Options(double target) {
  ReferenceOptions options;
  options.derivatives = 0;
  options.channels = 1;
  options.target_error = target;
  return options;
}

Look MirrorOf(double reflectance) { return {.material = MirrorDescription{SpectrumValues{reflectance}}}; }
Look Glass(double ior) { return {.material = DielectricDescription{ior}}; }

// `other`: how far the scenes' light may differ, relative.
void ExpectNear(const SceneMaker& one, const SceneMaker& two, double target, double other) {
  const SolvedReference left = SolveReference(one.Build(), Options(target));
  const SolvedReference right = SolveReference(two.Build(), Options(target));
  ASSERT_EQ(left.state, ReferenceSolver::State::kReached) << left.relative_error;
  ASSERT_EQ(right.state, ReferenceSolver::State::kReached) << right.relative_error;
  for (std::size_t i = 0; i < left.values.size(); ++i) {
    const ExactValue &l = left.values[i], &r = right.values[i];
    EXPECT_LE(std::abs(l.irradiance[0] - r.irradiance[0]),
              l.irradiance_error[0] + r.irradiance_error[0] + other * r.irradiance[0])
        << i;
    EXPECT_GT(l.irradiance[0], 0) << i;
  }
}

// The cubic that follows an arc of a circle: at the angle 0.5 to less than 1e-7 of its radius.
BezierDescription AlongArc(Point2 center, double radius, double start, double sweep) {
  const double k = 4.0 / 3 * std::tan(0.25 * sweep);
  const Vector2 a{std::cos(start), std::sin(start)}, b{std::cos(start + sweep), std::sin(start + sweep)};
  const Point2 p = center + radius * a, q = center + radius * b;
  return {p, p + (k * radius) * Left(a), q - (k * radius) * Left(b), q};
}

TEST(ReferenceSpecularBezierTest, APlaneMirrorCompletesARoomWithRoundThings) {
  const Look grey{.reflectance = {0.6}}, lamp{.radiance = {5}, .two_sided = true}, plate{.reflectance = {0.3}};
  const BezierDescription leaf{{0.3, -0.3}, {0.5, -0.16}, {0.7, -0.03}, {0.9, 0.1}};
  const BezierDescription other{{-0.9, 0.1}, {-0.7, -0.03}, {-0.5, -0.16}, {-0.3, -0.3}};
  SceneMaker half, whole;
  half.Segment("mirror", {0, 1}, {0, -1}, MirrorOf(1));
  half.Polyline("walls", {{0, -1}, {1.5, -1}, {1.5, 1}, {0, 1}}, false, grey);
  half.Segment("lamp", {0.4, 0.5}, {0.7, 0.6}, lamp).Bezier("leaf", leaf, plate);
  whole.Polyline("walls", {{0, -1}, {1.5, -1}, {1.5, 1}, {0, 1}}, false, grey);
  whole.Polyline("other walls", {{0, 1}, {-1.5, 1}, {-1.5, -1}, {0, -1}}, false, grey);
  whole.Segment("lamp", {0.4, 0.5}, {0.7, 0.6}, lamp).Bezier("leaf", leaf, plate);
  whole.Segment("lamp'", {-0.7, 0.6}, {-0.4, 0.5}, lamp).Bezier("leaf'", other, plate);
  for (SceneMaker* maker : {&half, &whole})
    for (const char* curve : {"walls", "leaf"}) maker->Probe(curve, 5);
  ExpectNear(half, whole, 1e-2, 0);
}

SceneMaker LitWall() {
  SceneMaker maker;
  maker.Segment("lamp", {0.2, 1.4}, {-0.2, 1.4}, {.radiance = {5}});
  maker.Segment("wall", {-1, -0.6}, {1, -0.6}, {.reflectance = {0.5}});
  maker.Probe("wall", 12);
  return maker;
}

TEST(ReferenceSpecularBezierTest, AStraightBezierIsAPlaneMirror) {
  SceneMaker plane = LitWall(), bezier = LitWall();
  plane.Segment("mirror", {-1.2, 0.9}, {-1.1, -0.5}, MirrorOf(0.9));
  bezier.Bezier("mirror", {{-1.2, 0.9}, {-1.18, 0.62}, {-1.13, -0.08}, {-1.1, -0.5}}, MirrorOf(0.9));
  ExpectNear(plane, bezier, 1e-4, 0);
}

TEST(ReferenceSpecularBezierTest, ARoundMirrorIsThatOfItsArc) {
  SceneMaker arc = LitWall(), bezier = LitWall();
  arc.Arc("mirror", {{-0.2, -0.4}, 1, 2.8, 0.5}, MirrorOf(0.9));
  bezier.Bezier("mirror", AlongArc({-0.2, -0.4}, 1, 2.8, 0.5), MirrorOf(0.9));
  ExpectNear(arc, bezier, 1e-4, 1e-5);
}

TEST(ReferenceSpecularBezierTest, ALensIsThatOfItsArcs) {
  SceneMaker arcs = LitWall(), beziers = LitWall();
  const double half = 0.25, up = 0.5 * std::numbers::pi, radius = 1.2, middle = 0.3, drop = radius * std::cos(half);
  // Fronts are outside.
  arcs.Arc("upper", {{0, middle - drop}, radius, up + half, -2 * half}, Glass(1.5));
  arcs.Arc("lower", {{0, middle + drop}, radius, -up + half, -2 * half}, Glass(1.5));
  beziers.Bezier("upper", AlongArc({0, middle - drop}, radius, up + half, -2 * half), Glass(1.5));
  beziers.Bezier("lower", AlongArc({0, middle + drop}, radius, -up + half, -2 * half), Glass(1.5));
  ExpectNear(arcs, beziers, 1e-2, 1e-5);
}

void ExpectFurnace(SceneMaker maker, double target) {
  maker.Polyline("walls", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, true, {.reflectance = {0.5}, .radiance = {0.5}});
  maker.Probe("walls", 8);  // None in a corner.
  const SolvedReference solved = SolveReference(maker.Build(), Options(target));
  EXPECT_EQ(solved.state, ReferenceSolver::State::kReached) << solved.relative_error;
  for (const ExactValue& value : solved.values) {
    EXPECT_LE(std::abs(value.irradiance[0] - 2), value.irradiance_error[0]);
    EXPECT_LE(value.irradiance_error[0], 2 * target);
  }
}

TEST(ReferenceSpecularBezierTest, AFurnaceWithAWavyMirrorIsLitAlikeEverywhere) {
  SceneMaker maker;
  maker.Bezier("mirror", {{-0.6, 0.1}, {-0.2, 0.7}, {0.1, -0.5}, {0.6, 0.2}}, MirrorOf(1));
  ExpectFurnace(maker, 1e-2);
}

TEST(ReferenceSpecularBezierTest, AFurnaceWithALeafOfGlassIsLitAlikeEverywhere) {
  SceneMaker maker;
  maker.Bezier("upper", {{-0.5, 0}, {-0.3, 0.4}, {0.2, 0.3}, {0.5, 0.1}}, Glass(1.5));
  maker.Bezier("lower", {{0.5, 0.1}, {0.3, -0.1}, {-0.2, -0.25}, {-0.5, 0}}, Glass(1.5));
  ExpectFurnace(maker, 1e-1);
}

}  // namespace
}  // namespace flatlight
