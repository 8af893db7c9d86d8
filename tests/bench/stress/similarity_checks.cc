// SPDX-License-Identifier: Apache-2.0
// The same scene, moved or written down in another way, must be lit the same.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/tolerances.h"
#include "tests/bench/stress/brute_force.h"
#include "tests/bench/stress/checks.h"
#include "tests/bench/stress/families.h"
#include "tests/bench/stress/random.h"
#include "tests/bench/stress/similarity.h"
#include "tests/bench/stress/solve.h"
#include "tests/bench/stress/text.h"

namespace flatlight::stress {
namespace {

// The receiver a little farther along its curve.
Receiver Stepped(const Receiver& receiver, double step) {
  Receiver moved = receiver;
  const double turn = receiver.curvature * step;
  moved.position = receiver.position + step * receiver.tangent + 0.5 * turn * step * receiver.normal;
  moved.tangent = Normalized(receiver.tangent + turn * receiver.normal);
  moved.normal = Normalized(receiver.normal - turn * receiver.tangent);
  return moved;
}

// Whether irradiance has a kink here, where derivatives depend on the side from which one looks, and rounding decides.
bool AtEvent(const Built& built, std::size_t point, const ExactValue& here) {
  constexpr double kStep = 0x1p-30;
  ExactSolver solver(*built.scene, built.caster->bvh(), {});
  const double slope = std::abs(here.gradient[0]), bend = std::abs(here.hessian[0]);
  for (const double step : {-kStep, kStep}) {
    const ExactValue there = solver.Evaluate(Stepped(*built.points[point], step));
    const double kink = std::abs(there.gradient[0] - here.gradient[0] - step * here.hessian[0]);
    const double jump = std::abs(there.hessian[0] - here.hessian[0]);
    if (kink > 8 * (here.gradient_error[0] + there.gradient_error[0]) + kStep * kStep * 100 * (1 + slope + bend) ||
        jump > 8 * (here.hessian_error[0] + there.hessian_error[0]) + kStep * 1e4 * (1 + bend)) {
      return true;
    }
  }
  return false;
}

struct Comparison {
  double size = 1;           // How much larger the other scene is.
  double radiance = 1;       // How much brighter the other scene is.
  double rounding = 0;       // How far the other scene's numbers are off, in units of this scene's world.
  bool reversed = false;     // Arc length grows the other way.
  std::vector<bool> turned;  // By point: gradients change their sign.
};

// What the rounding of the other scene does at one point.
Disturbance DisturbanceAt(const Built& built, const Receiver& receiver, double rounding) {
  Disturbance disturbance;
  disturbance.position = rounding / built.scene->frame().scale;
  if (receiver.element == ElementId::kNone) return disturbance;
  const Element& element = built.scene->element(receiver.element);
  // A short receiver turns.
  disturbance.direction = 2 * disturbance.position / Length(element.b - element.a);
  return disturbance;
}

// How near the nearest end of a curve is.
double NearestEnd(const Scene& scene, Point2 position) {
  double nearest = 2;
  for (const Element& element : scene.elements())
    nearest = std::min({nearest, Length(element.a - position), Length(element.b - position)});
  return nearest;
}

// Whether the value there depends on which side of another curve rounding puts the point, or on which of two curves.
bool IsAmbiguous(const Built& built, std::size_t i, double rounding, bool reversed) {
  const Receiver& receiver = *built.points[i];
  const double near = 512 * built.scene->touch_distance() + 8 * rounding / built.scene->frame().scale;
  if (reversed || rounding > 0) {
    for (const Element& element : built.scene->elements()) {
      if (std::min(Length(element.a - receiver.position), Length(element.b - receiver.position)) < near) return true;
    }
  }
  const double clearance = Clearance(*built.scene, receiver);
  if (rounding > 0 && clearance < 16 * rounding / built.scene->frame().scale) return true;
  if (clearance < near && (receiver.element == ElementId::kNone || reversed)) return true;
  return !MovedOnward(built, receiver).clear;
}

// Whether curves lie on others or on themselves, so that pieces of them were left out.
bool AnyIsCut(const Scene& scene) {
  for (const Curve& curve : scene.curves()) {
    double length = 0;
    for (std::uint32_t e = 0; e < curve.element_count; ++e) length += scene.elements()[curve.first_element + e].length;
    if (length < curve.length * (1 - 1e-12)) return true;
  }
  return false;
}

// Values of one scene against those of another form of it. At events only irradiance is compared.
Failure Compare(const std::string& name, const Built& a, const Built& b, const Comparison& how, Tally& tally) {
  const std::vector<ExactValue> values = SolveExact(a), others = SolveExact(b);
  const double light = b.scene->frame().radiance_scale / a.scene->frame().radiance_scale / how.radiance;
  const double length = a.scene->frame().scale * how.size / b.scene->frame().scale;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (IsAmbiguous(a, i, how.rounding, how.reversed)) {
      ++tally.counts[name + ": ambiguous points"];
      continue;
    }
    const ExactValue &v = values[i], &w = others[i];
    const double sign = !how.turned.empty() && how.turned[i] ? -1 : 1;
    const double irradiance = light * w.irradiance[0];
    const double gradient = sign * light * length * w.gradient[0], hessian = light * length * length * w.hessian[0];
    if (v.irradiance[0] == irradiance && v.gradient[0] == gradient && v.hessian[0] == hessian) {
      ++tally.counts[name + ": equal bits"];
      continue;
    }
    ++tally.counts[name + ": other bits"];
    // A bound is linear in what coordinates and directions are off by, so that it grows at most in proportion.
    const Disturbance disturbance = DisturbanceAt(a, *a.points[i], how.rounding);
    const double looseness =
        1 + disturbance.position / a.scene->coordinate_error() + disturbance.direction / (4 * kUnitRoundoff);
    const double stated = looseness * v.irradiance_error[0] + light * w.irradiance_error[0];
    // What is at the horizon, to rounding, adds nothing to irradiance yet.
    const double floor = disturbance.position * LargestRadiance(*a.scene);
    // What the other scene's rounding lifts above it grows as a square, which no proportion holds: of a direction's
    // turn by this much.
    const double q = disturbance.position > 0 ? 1 / NearestEnd(*a.scene, a.points[i]->position) : 0;
    const double turn = disturbance.position * q;
    const double lifted = turn * turn * LargestRadiance(*a.scene);
    double bound = stated + lifted;
    double gradient_bound =
        looseness * v.gradient_error[0] + light * length * w.gradient_error[0] + floor + 4 * lifted * q;
    double hessian_bound =
        looseness * v.hessian_error[0] + light * length * length * w.hessian_error[0] + floor + 16 * lifted * q * q;
    const auto agree = [&] {
      return std::abs(v.irradiance[0] - irradiance) <= bound && std::abs(v.gradient[0] - gradient) <= gradient_bound &&
             std::abs(v.hessian[0] - hessian) <= hessian_bound;
    };
    if (!agree()) {
      // Beyond what is stated: only where curves meet at so small an angle that the place where they do moves far.
      const double condition = IrradianceByRays(*a.scene, *a.points[i], disturbance).uncertain;
      bound += condition;
      gradient_bound *= 1 + condition / stated;
      hessian_bound *= 1 + condition / stated;
      ++tally.counts[name + ": beyond the stated bounds"];
    }
    if (!tally.Within(name + ": E", v.irradiance[0] - irradiance, bound)) {
      return Text("point ", i, ": irradiance ", v.irradiance[0], " became ", irradiance, " (stated errors ",
                  v.irradiance_error[0], ", ", light * w.irradiance_error[0], ", bound ", bound, ")");
    }
    if (!agree() && (AtEvent(a, i, v) || AtEvent(b, i, w))) {
      ++tally.counts[name + ": at events"];
      continue;
    }
    if (!tally.Within(name + ": gradient", v.gradient[0] - gradient, gradient_bound) ||
        !tally.Within(name + ": Hessian", v.hessian[0] - hessian, hessian_bound)) {
      return Text("point ", i, ": gradient ", v.gradient[0], " became ", gradient, " +- ", gradient_bound, ", Hessian ",
                  v.hessian[0], " became ", hessian, " +- ", hessian_bound);
    }
  }
  return std::nullopt;
}

std::vector<bool> PerPoint(const Scene& scene, const std::vector<bool>& per_probe) {
  std::vector<bool> per_point;
  for (std::size_t p = 0; p < per_probe.size(); ++p)
    per_point.insert(per_point.end(), scene.probes()[p].receivers.size(), per_probe[p]);
  return per_point;
}

double PowerOfTwo(Random& random) { return std::ldexp(1, random.Int(-30, 30)); }

}  // namespace

// Nothing rounds: the same bits, of direct light and of path tracing.
Failure CheckPowersOfTwo(const SceneDescription& description, std::uint64_t seed, Tally& tally) {
  const Built built(description);
  if (!built.scene) return std::nullopt;
  Random random(seed);
  Similarity similarity;
  similarity.scale = PowerOfTwo(random);
  const Built scaled(Moved(description, similarity));
  if (!scaled.scene) return "the scaled scene is refused";
  const std::vector<ExactValue> values = SolveExact(built), others = SolveExact(scaled);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].irradiance != others[i].irradiance || values[i].gradient != others[i].gradient ||
        values[i].hessian != others[i].hessian || values[i].irradiance_error != others[i].irradiance_error) {
      return Text("point ", i, ": scaled by ", similarity.scale, " the bits differ: ", values[i].irradiance[0], ", ",
                  others[i].irradiance[0]);
    }
  }
  const auto number = static_cast<std::uint32_t>(seed);
  const std::optional<Field> a = RenderField(built, Sampled(16, number, 2)),
                             b = RenderField(scaled, Sampled(16, number, 2));
  for (std::size_t p = 0; a && b && p < a->probes.size(); ++p) {
    if (a->probes[p].irradiance != b->probes[p].irradiance ||
        a->probes[p].standard_error != b->probes[p].standard_error)
      return Text("probe ", p, ": scaled by ", similarity.scale, " path tracing has other bits");
  }
  tally.counts["powers of two: equal points"] += values.size();
  return std::nullopt;
}

// Shifts and quarter turns that round nothing: within the stated errors, to 1e-9 of the largest there can be.
Failure CheckGridMoves(const SceneDescription& description, std::uint64_t seed, Tally& tally) {
  if (!IsOnGrid(description)) return std::nullopt;
  const Built built(description);
  if (!built.scene) return std::nullopt;
  Random random(seed);
  Similarity similarity;
  similarity.scale = PowerOfTwo(random);
  similarity.shift = similarity.scale * Vector2{0.125 * random.Int(-4096, 4096), 0.125 * random.Int(-4096, 4096)};
  similarity.quarters = random.Int(0, 3);
  const SceneDescription description_moved = Moved(description, similarity);
  const Built moved(description_moved);
  if (!moved.scene) return "the moved scene is refused";
  Comparison how;
  how.size = similarity.scale;
  if (similarity.quarters != 0) how.rounding = RoundingOfArcs(description);
  // Of a scene that was on a grid once, and was moved since, coordinates may be too fine for the shift.
  if (!IsExact(description, similarity)) how.rounding = RoundingOf(description_moved, similarity) / similarity.scale;
  return Compare("grid moves", built, moved, how, tally);
}

// Any scale, turn, shift and mirror: to what the rounding of the new numbers allows.
Failure CheckSimilarity(const SceneDescription& description, std::uint64_t seed, Tally& tally) {
  const Built built(description);
  if (!built.scene) return std::nullopt;
  Random random(seed);
  Similarity similarity;
  similarity.scale = random.Size(-9, 9);
  similarity.angle = random.Chance(0.8) ? random.Angle() : 0;
  // A curve that doubles back lies on itself, and mirrored begins with its other side.
  similarity.mirrored = random.Chance(0.3) && !HasOverlaps(description) && !AnyIsCut(*built.scene);
  if (random.Chance(0.7)) {
    const double far = random.Chance(0.3) ? random.Size(0, 6) : random.Uniform(0, 3);
    similarity.shift = similarity.scale * far * random.Direction();
  }
  const SceneDescription description_moved = Moved(description, similarity);
  const Built moved(description_moved);
  if (!moved.scene) return std::nullopt;  // Short pieces may round to nothing.
  Comparison how;
  how.size = similarity.scale;
  how.rounding = RoundingOf(description_moved, similarity) / similarity.scale;
  how.reversed = similarity.mirrored;
  how.turned.assign(built.points.size(), similarity.mirrored);
  return Compare("similarity", built, moved, how, tally);
}

Failure CheckOrder(const SceneDescription& description, std::uint64_t seed, Tally& tally) {
  if (HasOverlaps(description)) return std::nullopt;
  const Built built(description);
  if (!built.scene) return std::nullopt;
  const Built shuffled(Shuffled(description, seed));
  if (!shuffled.scene) return "the shuffled scene is refused";
  return Compare("order", built, shuffled, {}, tally);
}

Failure CheckReversal(const SceneDescription& description, std::uint64_t, Tally& tally) {
  const Built built(description);
  if (!built.scene) return std::nullopt;
  Comparison how;
  std::vector<bool> turned;
  const Built reversed(Reversed(description, turned));
  if (!reversed.scene) return "the reversed scene is refused";
  how.turned = PerPoint(*built.scene, turned);
  // Arcs and points are computed from the other end.
  how.rounding = RoundingOfArcs(description) + 4 * kUnitRoundoff * built.scene->frame().scale;
  how.reversed = true;
  return Compare("reversal", built, reversed, how, tally);
}

// Twice as bright is twice as bright, bit by bit; three times as bright to rounding.
Failure CheckLinearity(const SceneDescription& description, std::uint64_t seed, Tally& tally) {
  const Built built(description);
  if (!built.scene) return std::nullopt;
  Random random(seed);
  Comparison how;
  how.radiance = random.Chance(0.5) ? PowerOfTwo(random) : random.Size(-30, 30);
  SceneDescription brighter = description;
  for (CurveDescription& curve : brighter.curves) {
    if (!curve.emission) continue;
    for (double& value : curve.emission->radiance) value *= how.radiance;
  }
  const Built bright(brighter);
  if (!bright.scene) return "the brighter scene is refused";
  return Compare("linearity", built, bright, how, tally);
}

}  // namespace flatlight::stress
