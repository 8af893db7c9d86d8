// SPDX-License-Identifier: Apache-2.0
// A scene, built, and what the methods under test say about it.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_SOLVE_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_SOLVE_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/plane/exact/exact.h"
#include "core/plane/ray_caster.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/render/field.h"
#include "core/render/settings.h"
#include "core/scene/description.h"
#include "core/scene/scene.h"

namespace flatlight::stress {

struct Built {
  explicit Built(const SceneDescription& description);

  std::shared_ptr<const Scene> scene;  // Null if the description is refused.
  std::shared_ptr<const RayCaster> caster;
  std::shared_ptr<const Triangulation> triangulation;  // Null where there is none.
  std::vector<const Receiver*> points;                 // Of all probes.
};

// At every point of every probe; normalised units. With the triangulation, if there is one.
std::vector<ExactValue> SolveExact(const Built& built, bool occlusion = true);

// Through the door of all rendering, on this thread; world units. Absent if the plan is refused.
std::optional<Field> RenderField(const Built& built, const Settings& settings);

// Settings for path tracing of that many samples.
Settings Sampled(std::uint32_t samples, std::uint32_t seed, std::optional<std::uint32_t> max_bounces);
Settings ExactSettings();

// Where another curve passes through a receiver, what counts is what lies beyond, along its tangent. `away` is how far
// on one has to go to be off the other curve, 0 for a point on one curve only.
struct Onward {
  Receiver receiver;
  double away = 0;
  bool clear = true;  // False if even far on another curve is too near to tell on which side of it one is.
};
Onward MovedOnward(const Built& built, const Receiver& receiver);

// The distance from a receiver to the nearest curve that it does not lie on; normalised.
double Clearance(const Scene& scene, const Receiver& receiver);

// The largest radiance of any curve, in normalised units; first channel.
double LargestRadiance(const Scene& scene);

// Where point i of a curve probe lies, in lengths of the curve.
double FractionOf(const ProbeDescription& probe, std::size_t i);

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_SOLVE_H_
