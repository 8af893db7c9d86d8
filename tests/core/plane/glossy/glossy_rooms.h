// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_CORE_PLANE_GLOSSY_GLOSSY_ROOMS_H_
#define FLATLIGHT_TESTS_CORE_PLANE_GLOSSY_GLOSSY_ROOMS_H_

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/plane/glossy/glossy_solver.h"
#include "core/plane/ray_caster.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {

inline Look PhongOf(double reflectance, double exponent) {
  return {.material = PhongDescription{SpectrumValues{reflectance}, exponent}};
}

struct SolvedGloss {
  std::vector<ExactValue> values;  // By point, in units of the world.
  GlossySolver::State state = GlossySolver::State::kWorks;
  double relative_error = 0;
  int rounds = 0;
  std::size_t cells = 0;
};

inline SolvedGloss SolveGloss(const std::shared_ptr<const Scene>& scene, double target, int threads = 1,
                              int channels = 1) {
  ThreadPool pool(threads);
  ReferenceOptions options;
  options.derivatives = 0;
  options.channels = channels;
  options.target_error = target;
  GlossySolver solver(scene, std::make_shared<const RayCaster>(scene), options);
  const SteadyClock clock;
  const Cancellation never;
  while (solver.state() == GlossySolver::State::kWorks)
    solver.Advance(pool, threads, never, clock, Clock::Duration::max());
  SolvedGloss solved = {solver.values(), solver.state(), solver.relative_error(), solver.rounds(), solver.cells()};
  for (ExactValue& value : solved.values)
    for (Spectrum* s : {&value.irradiance, &value.irradiance_error}) *s = scene->frame().radiance_scale * *s;
  return solved;
}

// Grey rooms with a lamp, two things in them, and phong lobes of exponents from 0.5 to 100 on a wall and a thing, in
// every fourth on all walls; closed, or open to the sky; in every third a point light. 19 probe points.
inline std::shared_ptr<const Scene> GlossyRoom(std::uint64_t seed) {
  std::uint64_t state = seed * 0x9e3779b97f4a7c15u + 1;
  const auto between = [&](double low, double high) {
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return low + (high - low) * static_cast<double>(state >> 11) * 0x1p-53;
  };
  const auto dull = [&] { return Look{.reflectance = {between(0.2, 0.8)}}; };
  const auto glossy = [&] { return PhongOf(between(0.3, 0.8), std::pow(10, between(-0.3, 2))); };
  SceneMaker maker;
  maker.Segment("floor", {-1, -1}, {1, -1}, dull());
  maker.Segment("right", {1, -1}, {1, 1}, glossy());
  if (seed % 2 == 0) {
    maker.Segment("ceiling", {1, 1}, {-1, 1}, seed % 4 == 0 ? glossy() : dull());
    maker.Segment("left", {-1, 1}, {-1, -1}, seed % 4 == 0 ? glossy() : dull());
  } else {
    maker.Environment({0.3});
  }
  Look lamp = dull();
  lamp.radiance = {1};
  maker.Segment("lamp", {between(0.1, 0.6), 0.9}, {between(-0.6, 0), 0.85}, lamp);
  if (seed % 3 == 0) maker.Light(PointLightDescription{{between(-0.8, 0.8), 0.7}, {3}});
  constexpr double kTurn = 2 * std::numbers::pi;
  for (int i = 0; i < 2; ++i) {
    const double x = between(-0.7, 0.7), y = between(-0.7, 0.5), size = between(0.1, 0.3), angle = between(0, kTurn);
    const std::string name = "thing" + std::to_string(i);
    const Look look = i == 0 ? glossy() : dull();
    if (between(0, 1) < 0.5) {
      maker.Segment(name, {x, y}, {x + size * std::cos(angle), y + size * std::sin(angle)}, look);
    } else {
      maker.Arc(name, {{x, y}, size / 2, angle, between(0, 1) < 0.5 ? -kTurn : between(1, 5)}, look);
    }
  }
  maker.Probe("floor", 8).Probe("right", 7).Probe("thing1", 4);
  return maker.Build();
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CORE_PLANE_GLOSSY_GLOSSY_ROOMS_H_
