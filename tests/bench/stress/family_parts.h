// SPDX-License-Identifier: Apache-2.0
// What the families of scenes are made of.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_FAMILY_PARTS_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_FAMILY_PARTS_H_

#include <string>
#include <utility>
#include <vector>

#include "core/scene/description.h"
#include "tests/bench/stress/random.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight::stress {

inline constexpr double kPi = std::numbers::pi;

// Collects curves called c0, c1, ...
class Pieces {
 public:
  explicit Pieces(Random& random) : random_(random) {}

  // A dark curve, or one that emits on one side or both.
  Look AnyLook();
  static Look Dark(double reflectance = 0) { return {.reflectance = {reflectance}}; }
  static Look Lamp(double radiance = 1) { return {.radiance = {radiance}}; }
  static Look TwoSided(double radiance = 1) { return {.radiance = {radiance}, .two_sided = true}; }

  void Segment(Point2 a, Point2 b, const Look& look);  // Left out if it has no length.
  void Polyline(std::vector<Point2> points, bool closed, const Look& look);
  void Arc(Point2 center, double radius, double start, double sweep, const Look& look);

  void Bezier(const BezierDescription& bezier, const Look& look) { maker_.Bezier(NextName(), bezier, look); }

  // Probes of a few points on up to that many of the curves, on either side.
  void ProbeCurves(int most);
  void ProbeCurve(std::size_t curve, std::uint32_t count, Side side);
  void FreePoint(Point2 position, Vector2 normal) { maker_.PointProbe(position, normal); }
  void FreePoints(int count);  // Anywhere in [-1, 1]^2, facing anywhere.

  Random& random() { return random_; }
  std::size_t curves() const { return count_; }
  const CurveDescription& curve(std::size_t i) const { return maker_.description().curves[i]; }
  SceneDescription Take();

 private:
  std::string NextName() { return "c" + std::to_string(count_++); }

  Random& random_;
  SceneMaker maker_;
  std::size_t count_ = 0;
};

// The families, by file.
SceneDescription Scatter(Random& random);
SceneDescription Grid(Random& random);
SceneDescription GridArcs(Random& random);
SceneDescription Polygons(Random& random);
SceneDescription Arcs(Random& random);
SceneDescription Beziers(Random& random);
SceneDescription Nested(Random& random);
SceneDescription Crowd(Random& random);

SceneDescription Cluster(Random& random);
SceneDescription Slivers(Random& random);
SceneDescription Fan(Random& random);
SceneDescription Overlaps(Random& random);
SceneDescription Junctions(Random& random);
SceneDescription Keyhole(Random& random);
SceneDescription Sizes(Random& random);
SceneDescription WideArcs(Random& random);
SceneDescription Corners(Random& random);
SceneDescription Grazing(Random& random);
SceneDescription Tangents(Random& random);
SceneDescription Pencil(Random& random);
SceneDescription OneLine(Random& random);
SceneDescription WidePencil(Random& random);
SceneDescription WideLine(Random& random);

SceneDescription ClosedRoom(Random& random);
SceneDescription ClosedJunctions(Random& random);
SceneDescription ClosedArcs(Random& random);
SceneDescription ClosedBeziers(Random& random);

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_FAMILY_PARTS_H_
