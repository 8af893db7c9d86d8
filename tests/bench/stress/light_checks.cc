// SPDX-License-Identifier: Apache-2.0
// Direct light in closed form against independent ways to the same number.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/tolerances.h"
#include "core/render/light_paths.h"
#include "core/scene/element_frame.h"
#include "tests/bench/stress/brute_force.h"
#include "tests/bench/stress/checks.h"
#include "tests/bench/stress/families.h"
#include "tests/bench/stress/random.h"
#include "tests/bench/stress/solve.h"
#include "tests/bench/stress/text.h"
#include "tests/core/plane/exact/oracle.h"

namespace flatlight::stress {
namespace {

double LargestRadius(const Scene& scene) {
  double largest = 0;
  for (const Element& element : scene.elements()) largest = std::max(largest, element.radius);
  return largest;
}

// The oracle counts curves of one piece each.
SceneDescription InPieces(const SceneDescription& scene) {
  SceneDescription pieces = scene;
  pieces.curves.clear();
  for (const CurveDescription& curve : scene.curves) {
    const auto* polyline = std::get_if<PolylineDescription>(&curve.shape);
    if (polyline == nullptr) {
      pieces.curves.push_back(curve);
      continue;
    }
    const std::vector<Point2>& points = polyline->points;
    for (std::size_t i = 0; i + 1 < points.size() + (polyline->closed ? 1 : 0); ++i) {
      CurveDescription piece = curve;
      piece.name += " " + std::to_string(i);
      piece.shape = SegmentDescription{points[i], points[(i + 1) % points.size()]};
      pieces.curves.push_back(piece);
    }
  }
  return pieces;
}

std::optional<OracleValue> AskOracle(const Oracle& oracle, const SceneDescription& pieces,
                                     const ProbeDescription& probe, std::size_t i) {
  if (!probe.curve) return oracle.AtPoint(probe.points[i].position, probe.points[i].normal);
  for (std::size_t c = 0; c < pieces.curves.size(); ++c) {
    if (pieces.curves[c].name == *probe.curve)
      return oracle.OnCurve(c, FractionOf(probe, i), probe.side.value_or(Side::kFront));
  }
  return std::nullopt;
}

// Curves that end within the touch distance of others touch them; in 113 bits there may be a slit between them. At most
// what comes through.
double SlitLight(const Scene& scene, const Receiver& receiver) {
  double light = 0;
  const std::vector<Element>& elements = scene.elements();
  for (const Element& element : elements) {
    for (const Point2 end : {element.a, element.b}) {
      const bool slit = std::any_of(elements.begin(), elements.end(), [&](const Element& other) {
        return &other != &element && other.a != end && other.b != end &&
               DistanceTo(other, end) <= scene.touch_distance();
      });
      if (slit) light += scene.touch_distance() / Length(end - receiver.position);
    }
  }
  return LargestRadiance(scene) * light;
}

// Another seed for an independent rendering.
std::uint32_t Mixed32(std::uint32_t seed) { return static_cast<std::uint32_t>(Mixed(seed, 1)); }

std::size_t PointsOf(const ProbeDescription& probe) { return probe.curve ? *probe.count : probe.points.size(); }

// z beyond this in two independent estimates is a failure. In units of the stated error t_15 passes 6.5 once in 1e5, so
// that honest errors fail once in 1e10 points.
constexpr double kMostZ = 6;

// What is at the horizon to within rounding may be seen or not: the square of how far coordinates are off, amply.
constexpr double kAtHorizon = 1e-24;

}  // namespace

Failure CheckAgainstRays(const SceneDescription& description, std::uint64_t, Tally& tally) {
  const Built built(description);
  if (!built.scene || built.scene->elements().size() > 64) return std::nullopt;
  const std::vector<ExactValue> values = SolveExact(built);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Onward onward = MovedOnward(built, *built.points[i]);
    if (!onward.clear) {
      ++tally.counts["rays: points on curves that cannot be told apart"];
      continue;
    }
    const BruteIrradiance brute =
        IrradianceByRays(*built.scene, onward.receiver, {.position = built.scene->bezier_distance()});
    const double bound = values[i].irradiance_error[0] + brute.uncertain;
    const double difference = values[i].irradiance[0] - brute.value;
    // Farther on light has changed: at most by the square root, above a circle that stands upright there.
    const double moved = built.scene->traits().has_arcs ? 16 * std::sqrt(onward.away) : 1024 * onward.away;
    if (moved > 0 ? std::abs(difference) > bound + moved * LargestRadiance(*built.scene)
                  : !tally.Within("rays: E", difference, bound)) {
      return Text("point ", i, ": exact ", values[i].irradiance[0], " +- ", values[i].irradiance_error[0], ", by rays ",
                  brute.value, " +- ", brute.uncertain);
    }
  }
  return std::nullopt;
}

Failure CheckAgainstOracle(const SceneDescription& description, std::uint64_t, Tally& tally) {
  const Built built(description);
  if (!built.scene || HasOverlaps(description) || built.scene->elements().size() > 24) return std::nullopt;
  if (LargestRadius(*built.scene) > 4 || !built.scene->beziers().empty()) return std::nullopt;
  const SceneDescription pieces = InPieces(description);
  const Oracle oracle(pieces);
  const std::vector<ExactValue> values = SolveExact(built);
  const Frame& frame = built.scene->frame();
  const double l = frame.radiance_scale, k = frame.scale;
  std::size_t point = 0;
  for (const ProbeDescription& probe : description.probes) {
    for (std::size_t i = 0; i < PointsOf(probe); ++i, ++point) {
      const Receiver& receiver = *built.points[point];
      // In 113 bits a point is not on the curve that it lies on by its rounding.
      if (Clearance(*built.scene, receiver) < 1e-9 || (!probe.curve && receiver.element != ElementId::kNone)) continue;
      const std::optional<OracleValue> truth = AskOracle(oracle, pieces, probe, i);
      if (!truth) continue;
      const ExactValue& v = values[point];
      const double slit = SlitLight(*built.scene, receiver);
      const std::string where = Text("point ", point, ": ");
      // On top of the bounds what the oracle's differences may err by themselves.
      if (!tally.Within("oracle: E", v.irradiance[0] * l - truth->irradiance,
                        (v.irradiance_error[0] + slit) * l + 1e-15 * truth->size)) {
        return Text(where, "exact ", v.irradiance[0] * l, " +- ", v.irradiance_error[0] * l, ", truth ",
                    truth->irradiance);
      }
      const double gradient = v.gradient[0] * l / k - truth->gradient;
      const double gradient_bound = v.gradient_error[0] * l / k + 1e-13 * (truth->size / k + std::abs(truth->gradient));
      const double hessian = v.hessian[0] * l / k / k - truth->hessian;
      const double hessian_bound =
          v.hessian_error[0] * l / k / k + 1e-10 * (truth->size / k / k + std::abs(truth->hessian));
      if (slit > 0 && (std::abs(gradient) > gradient_bound || std::abs(hessian) > hessian_bound)) {
        ++tally.counts["oracle: derivatives of slits"];
        continue;
      }
      if (!tally.Within("oracle: gradient", gradient, gradient_bound)) {
        return Text(where, "exact gradient ", v.gradient[0] * l / k, " +- ", v.gradient_error[0] * l / k, ", truth ",
                    truth->gradient);
      }
      if (!tally.Within("oracle: Hessian", hessian, hessian_bound)) {
        return Text(where, "exact Hessian ", v.hessian[0] * l / k / k, " +- ", v.hessian_error[0] * l / k / k,
                    ", truth ", truth->hessian);
      }
      // How wide the bounds are: what they allow, relative to the sizes of the terms.
      if (truth->size > 0)
        tally.ratios["bound of E / size of terms / 2^-53"].Add(v.irradiance_error[0] * l / truth->size / kUnitRoundoff);
    }
  }
  return std::nullopt;
}

Failure CheckTriangles(const SceneDescription& description, std::uint64_t, Tally& tally) {
  const Built built(description);
  if (!built.scene || built.scene->traits().has_arcs) return std::nullopt;
  if (!built.triangulation) {
    ++tally.counts["triangles: scenes without"];
    return std::nullopt;
  }
  ExactSolver tree(*built.scene, built.caster->bvh(), {});
  ExactSolver triangles(*built.scene, built.caster->bvh(), {}, built.triangulation.get());
  for (std::size_t i = 0; i < built.points.size(); ++i) {
    const Receiver& receiver = *built.points[i];
    const ExactValue a = triangles.Evaluate(receiver), b = tree.Evaluate(receiver);
    if (!tally.Within("triangles: E", a.irradiance[0] - b.irradiance[0],
                      a.irradiance_error[0] + b.irradiance_error[0])) {
      return Text("point ", i, ": ", a.irradiance[0], " by triangles, ", b.irradiance[0], " by the tree");
    }
    if (!tally.Within("triangles: gradient", a.gradient[0] - b.gradient[0],
                      a.gradient_error[0] + b.gradient_error[0]) ||
        !tally.Within("triangles: Hessian", a.hessian[0] - b.hessian[0], a.hessian_error[0] + b.hessian_error[0])) {
      return Text("point ", i, ": derivatives ", a.gradient[0], " ", a.hessian[0], " by triangles, ", b.gradient[0],
                  " ", b.hessian[0], " by the tree");
    }
  }
  tally.counts["triangles: points"] += built.points.size();
  tally.counts["triangles: points left to the tree"] += static_cast<std::uint64_t>(triangles.undecided());
  return std::nullopt;
}

Failure CheckSampling(const SceneDescription& description, std::uint64_t seed, Tally& tally) {
  const Built built(description);
  if (!built.scene) return std::nullopt;
  const auto number = static_cast<std::uint32_t>(seed);
  const std::optional<Field> exact = RenderField(built, ExactSettings());
  const std::optional<Field> sampled = RenderField(built, Sampled(128, number, 0));
  // Says how much each point counts in what is pooled: independent of what it weighs, or means would not be 0.
  const std::optional<Field> weigher = RenderField(built, Sampled(128, Mixed32(number), 0));
  std::optional<Field> again;
  if (!exact || !sampled || !weigher) return "a rendering was refused";
  double bias = 0, spread = 0;
  bool pooled = false;
  std::size_t point = 0;
  for (std::size_t p = 0; p < exact->probes.size(); ++p) {
    for (std::size_t i = 0; i < exact->probes[p].irradiance.size(); ++i, ++point) {
      const Onward onward = MovedOnward(built, *built.points[point]);
      if (!onward.clear) continue;
      const double moved = LargestRadiance(*built.scene) * built.scene->frame().radiance_scale *
                               (built.scene->traits().has_arcs ? 16 * std::sqrt(onward.away) : 1024 * onward.away) +
                           kAtHorizon * LargestRadiance(*built.scene) * built.scene->frame().radiance_scale;
      const double truth = exact->probes[p].irradiance[i];
      const auto deviation = [&](const Field& field) {
        const double difference =
            std::max(0.0, std::abs(field.probes[p].irradiance[i] - truth) - *exact->error_bound - moved);
        return difference == 0 ? 0 : difference / field.probes[p].standard_error[i];
      };
      const double allowed = *exact->error_bound + moved, off = sampled->probes[p].irradiance[i] - truth;
      const double stated = sampled->probes[p].standard_error[i];
      const double expected = weigher->probes[p].standard_error[i];
      if (expected > 100 * allowed) {
        // One that missed what little light there is says so by its own distance from the truth.
        const double scale = std::hypot(expected, weigher->probes[p].irradiance[i] - truth);
        bias += off / scale, spread += (off / scale) * (off / scale) - (stated / scale) * (stated / scale);
        pooled = true;
      }
      const double z = deviation(*sampled);
      if (!(z >= 0)) return Text("probe ", p, " value ", i, ": sampled ", sampled->probes[p].irradiance[i]);
      if (stated > 100 * allowed) tally.deviations["sampling"].Add(off / stated);
      if (z <= kMostZ) continue;
      ++tally.counts["sampled again"];
      if (!again) again = RenderField(built, Sampled(2048, number + 1, 0));
      if (deviation(*again) <= kMostZ) continue;
      return Text("probe ", p, " value ", i, ": exact ", truth, " +- ", *exact->error_bound, ", sampled ",
                  sampled->probes[p].irradiance[i], " +- ", sampled->probes[p].standard_error[i], " and ",
                  again->probes[p].irradiance[i], " +- ", again->probes[p].standard_error[i]);
    }
  }
  if (pooled) {
    for (const std::string& of : {std::string("all"), description.name}) {
      tally.biases["sampling: " + of].Add(bias);
      tally.excesses["sampling: " + of].Add(spread);
    }
  }
  return std::nullopt;
}

Failure CheckVisibilitySkip(const SceneDescription& description, std::uint64_t, Tally& tally) {
  const Built built(description);
  if (!built.scene || !NothingBlocks(*built.scene)) return std::nullopt;
  const std::vector<ExactValue> with = SolveExact(built), without = SolveExact(built, false);
  for (std::size_t i = 0; i < with.size(); ++i) {
    const ExactValue &a = with[i], &b = without[i];
    if (!tally.Within("visibility skip: E", a.irradiance[0] - b.irradiance[0],
                      a.irradiance_error[0] + b.irradiance_error[0])) {
      return Text("point ", i, ": ", a.irradiance[0], " with occlusion, ", b.irradiance[0], " without");
    }
    if (!tally.Within("visibility skip: gradient", a.gradient[0] - b.gradient[0],
                      a.gradient_error[0] + b.gradient_error[0]) ||
        !tally.Within("visibility skip: Hessian", a.hessian[0] - b.hessian[0],
                      a.hessian_error[0] + b.hessian_error[0])) {
      return Text("point ", i, ": derivatives ", a.gradient[0], " ", a.hessian[0], " with occlusion, ", b.gradient[0],
                  " ", b.hessian[0], " without");
    }
  }
  return std::nullopt;
}

Failure CheckClosed(const SceneDescription& description, std::uint64_t seed, Tally& tally) {
  if (!IsClosed(description)) return std::nullopt;
  const Built built(description);
  if (!built.scene) return std::nullopt;
  const std::vector<ExactValue> values = SolveExact(built);
  const std::optional<Field> sampled = RenderField(built, Sampled(64, static_cast<std::uint32_t>(seed), std::nullopt));
  if (!sampled) return "path tracing was refused";
  std::vector<double> means;
  for (const ProbeField& probe : sampled->probes)
    means.insert(means.end(), probe.irradiance.begin(), probe.irradiance.end());
  std::optional<Oracle> oracle;
  std::optional<SceneDescription> pieces;
  std::size_t point = 0;
  for (const ProbeDescription& probe : description.probes) {
    for (std::size_t i = 0; i < PointsOf(probe); ++i, ++point) {
      ++tally.counts["points in closed rooms"];
      const ExactValue& v = values[point];
      if (v.irradiance[0] == 0 && v.gradient[0] == 0 && v.hessian[0] == 0 && means[point] == 0) continue;
      // Walls that meet to rounding only leave slits of rounding's size, to the closed form.
      const double slit = IrradianceByRays(*built.scene, *built.points[point]).uncertain;
      if (v.irradiance[0] <= v.irradiance_error[0] + slit && means[point] == 0) {
        ++tally.counts[v.irradiance[0] <= v.irradiance_error[0] ? "points in closed rooms with light within its bound"
                                                                : "points in closed rooms with light beyond its bound"];
        continue;
      }
      // A room that is open reads light with good reason (one from which curves were dropped, for instance).
      if (built.scene->beziers().empty()) {  // The oracle does not know them.
        if (!oracle) pieces = InPieces(description), oracle.emplace(*pieces);
        const std::optional<OracleValue> truth = AskOracle(*oracle, *pieces, probe, i);
        if (truth && truth->irradiance > 1e-9 * LargestRadiance(*built.scene)) continue;
        if (!truth && probe.curve) continue;
      }
      return Text("point ", point, ": exact ", v.irradiance[0], ", gradient ", v.gradient[0], ", Hessian ",
                  v.hessian[0], ", sampled ", means[point], " in a closed room");
    }
  }
  return std::nullopt;
}

}  // namespace flatlight::stress
