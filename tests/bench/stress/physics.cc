// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/physics.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/bench/stress/family_parts.h"
#include "tests/bench/stress/flux.h"
#include "tests/bench/stress/solve.h"
#include "tests/bench/stress/text.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight::stress {
namespace {

// Beyond so many standard errors a mean of hundreds of values is wrong; honest ones get there once in 5e8.
constexpr double kMostZ = 6;

constexpr double kFullTurn = 2 * std::numbers::pi;

std::uint32_t Number(std::uint64_t seed) { return static_cast<std::uint32_t>(Mixed(seed, 77)); }

// In a closed room where all walls emit L and reflect rho, E = 2 L / (1 - rho). A path lives for some 2e4 rays, no
// more.
Failure Furnace(std::uint64_t seed) {
  constexpr double kReflectance = 0.9999, kTruth = 2 / (1 - kReflectance);
  const Look look{.reflectance = {kReflectance}, .radiance = {1}};
  SceneMaker ring;
  ring.Arc("ring", {{5, 5}, 2, 1, kFullTurn}, look);
  ring.Probe("ring", 1);
  for (const SceneMaker& room : {SquareRoom(look, 1), ring}) {
    const Built built(room.description());
    const std::optional<Field> field = RenderField(built, Sampled(16, Number(seed), std::nullopt));
    if (!field) return "refused";
    double samples = 0;
    for (const ProbeField& probe : field->probes) {
      samples += probe.samples[0];
      if (!(std::abs(probe.irradiance[0] - kTruth) <= kMostZ * probe.standard_error[0])) {
        return Text("E is ", probe.irradiance[0], " +- ", probe.standard_error[0], " for ", kTruth);
      }
    }
    // From weight 1 to 1/4 by factors of rho, then halved by roulette at every ln 2 / (1 - rho) reflections: 2 rays
    // each.
    const double expected = 2 * (std::log(4.0) + std::log(2.0)) / (1 - kReflectance);
    if (field->rays > 1.5 * expected * samples) return Text(field->rays / samples, " rays a path, expected ", expected);
  }
  return std::nullopt;
}

SceneMaker Furniture(const Look& lamp) {
  SceneMaker maker;
  maker.Polyline("walls", {{0, 0}, {4, 0}, {4, 3}, {1, 3.5}, {0, 2}}, true, {.reflectance = {0.7}});
  maker.Segment("lamp", {2.5, 2.6}, {1.5, 2.7}, lamp);
  maker.Arc("disc", {{2.9, 0.8}, 0.4, 0.3, -kFullTurn}, {.reflectance = {0.5}});
  maker.Arc("bowl", {{1.1, 0.9}, 0.5, 3.3, 2.8}, {.reflectance = {0.9}});
  maker.Segment("shelf", {0, 1.7}, {0.9, 1.6}, {.reflectance = {0.4}});
  return maker;
}

// What is emitted is absorbed.
Failure EnergyBalance(std::uint64_t seed) {
  const SceneMaker maker = Furniture({.reflectance = {0.3}, .radiance = {5}, .two_sided = true});
  const double emitted = 2 * 2 * 5 * std::hypot(1, 0.1);  // A Lambertian side emits 2 L a length.
  Flux absorbed;
  for (const FluxSide& side :
       {FluxSide{"walls", Side::kFront, 0.3}, FluxSide{"lamp", Side::kFront, 0.7}, FluxSide{"lamp", Side::kBack, 0.7},
        FluxSide{"disc", Side::kFront, 0.5}, FluxSide{"bowl", Side::kFront, 0.1}, FluxSide{"bowl", Side::kBack, 0.1},
        FluxSide{"shelf", Side::kFront, 0.6}, FluxSide{"shelf", Side::kBack, 0.6}}) {
    const std::optional<Flux> flux = MeasureFlux(maker.description(), side, 96, 64, seed);
    if (!flux) return "refused";
    absorbed.watts += flux->watts;
    absorbed.variance += flux->variance;
  }
  const double error = std::sqrt(absorbed.variance);
  if (std::abs(absorbed.watts - emitted) <= kMostZ * error && error < 0.01 * emitted) return std::nullopt;
  return Text("emitted ", emitted, " W, absorbed ", absorbed.watts, " +- ", error, " W");
}

// The flux that reaches B from A of radiance 1 is that which reaches A from B of radiance 1, reflections included.
Failure Reciprocity(std::uint64_t seed) {
  const auto scene = [](bool a_emits) {
    SceneMaker maker = Furniture({.reflectance = {0.3}});
    SceneDescription description = maker.description();
    for (CurveDescription& curve : description.curves) {
      if (curve.name == (a_emits ? "shelf" : "disc")) curve.emission = EmissionDescription{{1}, false};
    }
    return description;
  };
  const std::optional<Flux> there = MeasureFlux(scene(true), {"disc", Side::kFront, 1}, 256, 64, seed);
  const std::optional<Flux> back = MeasureFlux(scene(false), {"shelf", Side::kFront, 1}, 256, 64, seed + 1);
  if (!there || !back) return "refused";
  const double error = std::sqrt(there->variance + back->variance);
  if (std::abs(there->watts - back->watts) <= kMostZ * error && error < 0.02 * there->watts) return std::nullopt;
  return Text(there->watts, " W there, ", back->watts, " W back, +- ", error);
}

SceneMaker Stage() {
  SceneMaker maker;
  maker.Segment("floor", {-2, 0}, {2, 0});
  maker.Segment("post", {0.3, 0.2}, {0.4, 0.9});
  maker.Probe("floor", 8);
  return maker;
}

// From the smallest radiance there is to the largest allowed: E is proportional, to the last digits that E can have.
Failure RadianceRange(std::uint64_t seed) {
  const auto lit = [](double radiance) {
    SceneMaker maker = Stage();
    maker.Segment("lamp", {1, 2}, {-1, 2}, {.radiance = {radiance}});
    return maker.description();
  };
  const Built one(lit(1));
  const std::array<Settings, 2> methods{ExactSettings(), Sampled(64, Number(seed), 0)};
  for (const Settings& settings : methods) {
    const std::optional<Field> unit = RenderField(one, settings);
    for (const double radiance : {5e-324, 1e-310, 1e-300, 1e-30, 3.0, 1e30, 1e100}) {
      const std::optional<Field> field = RenderField(Built(lit(radiance)), settings);
      if (!unit || !field) return "refused";
      for (std::size_t i = 0; i < 8; ++i) {
        const double value = field->probes[0].irradiance[i], expected = radiance * unit->probes[0].irradiance[i];
        if (!(std::abs(value - expected) <= 1e-14 * expected + 2 * std::numeric_limits<double>::denorm_min())) {
          return Text("radiance ", radiance, ": E is ", value, " instead of ", expected);
        }
      }
    }
  }
  // What leaves the range of numbers is infinite, not wrong.
  SceneMaker tiny;
  tiny.Segment("floor", {-2e-120, 0}, {2e-120, 0});
  tiny.Segment("lamp", {1e-120, 2e-120}, {-1e-120, 2e-120}, {.radiance = {1e100}});
  tiny.Probe("floor", 2);
  const std::optional<Field> field = RenderField(Built(tiny.description()), ExactSettings());
  if (!field) return "the tiny scene is refused";
  if (!std::isfinite(field->probes[0].irradiance[0]) || !std::isfinite(field->probes[0].gradient[0]) ||
      !std::isinf(field->probes[0].hessian[0])) {
    return Text("a Hessian of 1e340 reads ", field->probes[0].hessian[0]);
  }
  return std::nullopt;
}

// Two lamps that do not hide each other add up.
Failure Superposition(std::uint64_t seed) {
  const auto lit = [](bool left, bool right) {
    SceneMaker maker = Stage();
    maker.Segment("left", {-0.5, 2}, {-1, 2}, left ? Pieces::Lamp(0.7) : Look{});
    maker.Segment("right", {1.3, 2.1}, {0.5, 2}, right ? Pieces::Lamp(3.1) : Look{});
    return maker.description();
  };
  const Built both(lit(true, true)), left(lit(true, false)), right(lit(false, true));
  const std::optional<Field> sum = RenderField(both, ExactSettings());
  const std::optional<Field> a = RenderField(left, ExactSettings()), b = RenderField(right, ExactSettings());
  const std::optional<Field> sampled = RenderField(both, Sampled(256, Number(seed), 0));
  if (!sum || !a || !b || !sampled) return "refused";
  const double bound = *sum->error_bound + *a->error_bound + *b->error_bound;
  for (std::size_t i = 0; i < 8; ++i) {
    const double expected = a->probes[0].irradiance[i] + b->probes[0].irradiance[i];
    if (!(std::abs(sum->probes[0].irradiance[i] - expected) <= bound)) return Text("exact: sum off at point ", i);
    const double difference = std::abs(sampled->probes[0].irradiance[i] - expected);
    if (!(difference <= kMostZ * sampled->probes[0].standard_error[i])) return Text("sampled: sum off at point ", i);
  }
  return std::nullopt;
}

// A lamp of two sides is, on each side, a lamp of one that faces there.
Failure TwoSides(std::uint64_t seed) {
  const auto lit = [](bool turned, bool both) {
    SceneMaker maker = Stage();
    const Look look{.radiance = {1.5}, .two_sided = both};
    turned ? maker.Segment("lamp", {-1, 2}, {1, 1.8}, look) : maker.Segment("lamp", {1, 1.8}, {-1, 2}, look);
    maker.PointProbe({0.2, 3}, {0, -1});
    return maker.description();
  };
  const Built two(lit(false, true)), down(lit(false, false)), up(lit(true, false));
  const std::array<Settings, 2> methods{ExactSettings(), Sampled(64, Number(seed), 0)};
  for (const Settings& settings : methods) {
    const std::optional<Field> a = RenderField(two, settings), b = RenderField(down, settings),
                               c = RenderField(up, settings);
    if (!a || !b || !c) return "refused";
    if (a->probes[0].irradiance != b->probes[0].irradiance) return "below, two sides are not one that faces down";
    if (std::abs(a->probes[1].irradiance[0] - c->probes[1].irradiance[0]) > 1e-14) {
      return "above, two sides are not one that faces up";
    }
    if (b->probes[1].irradiance[0] != 0 || c->probes[0].irradiance[0] != 0) return "a lamp shines from its back";
  }
  return std::nullopt;
}

// Black curves where no light passes change no bit of direct light.
Failure UnseenOccluders(std::uint64_t seed) {
  SceneMaker maker = Stage();
  maker.Segment("lamp", {1, 2}, {-1, 2}, {.radiance = {1}});
  const Built plain(maker.description());
  Random random(seed);
  for (int i = 0; i < 300; ++i) {
    // Below the floor and above the lamp, within the box of both.
    const double x = random.Uniform(-1.9, 1.9),
                 y = random.Chance(0.5) ? -random.Uniform(0.1, 1.5) : random.Uniform(2.1, 3);
    maker.Segment("black " + std::to_string(i), {x, y},
                  {x + random.Uniform(-0.05, 0.05), y + random.Uniform(0.01, 0.05)});
  }
  const Built crowded(maker.description());
  const std::array<Settings, 2> methods{ExactSettings(), Sampled(256, Number(seed), 0)};
  for (const Settings& settings : methods) {
    const std::optional<Field> a = RenderField(plain, settings), b = RenderField(crowded, settings);
    if (!a || !b) return "refused";
    if (a->probes[0].irradiance != b->probes[0].irradiance || a->probes[0].hessian != b->probes[0].hessian)
      return "light has changed";
  }
  return std::nullopt;
}

}  // namespace

const std::vector<PhysicsCheck>& PhysicsChecks() {
  static const auto& checks = *new std::vector<PhysicsCheck>{
      {"furnace at reflectance 0.9999", Furnace},
      {"energy balance", EnergyBalance},
      {"reciprocity", Reciprocity},
      {"radiance of any size", RadianceRange},
      {"superposition", Superposition},
      {"two-sided lamps", TwoSides},
      {"occluders that are not seen", UnseenOccluders},
  };
  return checks;
}

}  // namespace flatlight::stress
