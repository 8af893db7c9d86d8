// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/solve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/render/plan.h"
#include "core/render/probe_points.h"
#include "core/render/rendering.h"
#include "core/scene/element_frame.h"

namespace flatlight::stress {

Built::Built(const SceneDescription& description) {
  Diagnostics diagnostics;
  scene = BuildScene(description, diagnostics);
  if (scene == nullptr) return;
  caster = std::make_shared<const RayCaster>(scene);
  triangulation = Triangulation::Of(*scene);
  points = PointsOfProbes(*scene);
}

std::vector<ExactValue> SolveExact(const Built& built, bool occlusion) {
  ExactSolver solver(*built.scene, built.caster->bvh(), {.occlusion = occlusion}, built.triangulation.get());
  std::vector<ExactValue> values;
  values.reserve(built.points.size());
  for (const Receiver* point : built.points) values.push_back(solver.Evaluate(*point));
  return values;
}

std::optional<Field> RenderField(const Built& built, const Settings& settings) {
  Diagnostics diagnostics;
  const std::optional<Plan> plan = MakePlan(*built.scene, settings, diagnostics);
  if (!plan) return std::nullopt;
  const std::unique_ptr<Rendering> rendering = StartRendering(built.scene, *plan);
  InlineExecutor executor;
  const Cancellation never;
  const SteadyClock clock;
  while (!rendering->done()) rendering->Advance(executor, never, clock, Clock::Duration::max());
  return *rendering->Snapshot();
}

Settings Sampled(std::uint32_t samples, std::uint32_t seed, std::optional<std::uint32_t> max_bounces) {
  Settings settings;
  settings.method = Method::kPathTracing;
  settings.samples = samples;
  settings.seed = seed;
  settings.max_bounces = max_bounces;
  return settings;
}

Settings ExactSettings() {
  Settings settings;
  settings.method = Method::kExact;
  settings.max_bounces = 0;
  settings.derivatives = Derivatives::kHessian;
  return settings;
}

double Clearance(const Scene& scene, const Receiver& receiver) {
  double least = std::numeric_limits<double>::infinity();
  for (const Element& element : scene.elements()) {
    if (receiver.element != ElementId::kNone && scene.element(receiver.element).carrier == element.carrier) continue;
    least = std::min(least, DistanceTo(element, receiver.position));
  }
  return least;
}

namespace {

// Whether an arc ends near the receiver and its circle passes through it: then rounding decides which side is seen.
bool IsBesideItsEnd(const Scene& scene, const Receiver& receiver) {
  for (const Element& arc : scene.elements()) {
    if (arc.kind != Element::Kind::kArc) continue;
    if (receiver.element != ElementId::kNone && scene.element(receiver.element).carrier == arc.carrier) continue;
    const Vector2 q = receiver.position - arc.a;
    const double height = Dot(q, arc.radial_a) + LengthSquared(q) / (2 * arc.radius);
    const double distance = std::min(Length(q), Length(arc.b - receiver.position));
    if (std::abs(height) < 16 * scene.touch_distance() && distance < 1e-6 && distance > scene.touch_distance())
      return true;
  }
  return false;
}

}  // namespace

Onward MovedOnward(const Built& built, const Receiver& receiver) {
  Onward onward{receiver};
  if (IsBesideItsEnd(*built.scene, receiver)) {
    onward.clear = false;
    return onward;
  }
  if (!built.caster->Touches({receiver.position, receiver.element})) {
    // Not on it, but hardly off it.
    onward.clear = Clearance(*built.scene, receiver) > 16 * built.scene->touch_distance();
    // Close to a corner, where walls are nearer to each other than they are known.
    for (const Element& element : built.scene->elements()) {
      if (receiver.element != ElementId::kNone) break;
      const double end = std::min(Length(element.a - receiver.position), Length(element.b - receiver.position));
      onward.clear = onward.clear && end > 1024 * built.scene->touch_distance();
    }
    return onward;
  }
  const auto at = [&](double away) {
    return receiver.position + away * receiver.tangent + 0.5 * receiver.curvature * away * away * receiver.normal;
  };
  for (onward.away = 0x1p-40; onward.away < 0x1p-20; onward.away *= 2) {
    onward.receiver.position = at(onward.away);
    if (built.caster->Touches({onward.receiver.position, receiver.element})) continue;
    // Somewhat farther still, so that sides are beyond doubt.
    onward.away *= 8;
    onward.receiver.position = at(onward.away);
    // Not past another place where something happens.
    for (const Element& element : built.scene->elements()) {
      for (const Point2 end : {element.a, element.b}) {
        const double distance = Length(end - receiver.position);
        onward.clear = onward.clear && (distance <= built.scene->touch_distance() || distance > 4 * onward.away);
      }
    }
    return onward;
  }
  onward.clear = false;
  return onward;
}

double LargestRadiance(const Scene& scene) {
  double largest = 0;
  for (const Curve& curve : scene.curves()) largest = std::max(largest, curve.radiance[0]);
  return largest;
}

double FractionOf(const ProbeDescription& probe, std::size_t i) {
  const double from = probe.from.value_or(0), to = probe.to.value_or(1);
  return from + (static_cast<double>(i) + 0.5) / *probe.count * (to - from);
}

}  // namespace flatlight::stress
