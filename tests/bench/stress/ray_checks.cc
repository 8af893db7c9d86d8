// SPDX-License-Identifier: Apache-2.0
// Scenes build, values are numbers, and the tree finds what brute force finds.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/scene/element_frame.h"
#include "tests/bench/stress/brute_force.h"
#include "tests/bench/stress/checks.h"
#include "tests/bench/stress/families.h"
#include "tests/bench/stress/random.h"
#include "tests/bench/stress/solve.h"
#include "tests/bench/stress/text.h"

namespace flatlight::stress {
namespace {

// A place that rays may leave from or end at: anywhere, on elements, on vertices, at probes.
SurfacePoint AnyPlace(const Built& built, Random& random) {
  const std::vector<Element>& elements = built.scene->elements();
  const auto any = static_cast<std::size_t>(random.Below(elements.size()));
  switch (random.Below(5)) {
    case 0:
      return {random.Point(), ElementId::kNone};
    case 1:
      return {FrameAt(elements[any], random.Next()).position, static_cast<ElementId>(any)};
    case 2:
      return {random.Chance(0.5) ? elements[any].a : elements[any].b, static_cast<ElementId>(any)};
    case 3:
      return {random.Chance(0.5) ? elements[any].a : elements[any].b, ElementId::kNone};
    default: {
      const Receiver& receiver = *built.points[random.Below(built.points.size())];
      return {receiver.position, receiver.element};
    }
  }
}

Vector2 AnyDirection(const Built& built, const SurfacePoint& from, Random& random) {
  constexpr std::array<Vector2, 6> kAxes{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}}};
  const std::uint64_t kind = random.Below(4);
  if (kind == 0) return random.Size(-3, 3) * random.Direction();
  if (kind == 1) return kAxes[random.Below(kAxes.size())];
  const Vector2 toward = AnyPlace(built, random).position - from.position;
  return LengthSquared(toward) > 0 ? toward : random.Direction();
}

std::string Describe(const std::optional<Hit>& hit) {
  return hit ? Text("element ", static_cast<std::uint32_t>(hit->element), " at ", hit->distance) : "nothing";
}

}  // namespace

Failure CheckBuilds(const SceneDescription& scene, std::uint64_t, Tally&) {
  Diagnostics diagnostics;
  if (BuildScene(scene, diagnostics) != nullptr) return std::nullopt;
  return Text("refused: ", diagnostics.kept()[0].path, ": ", diagnostics.kept()[0].message);
}

Failure CheckFinite(const SceneDescription& description, std::uint64_t, Tally& tally) {
  const Built built(description);
  if (!built.scene) return std::nullopt;
  const std::vector<ExactValue> values = SolveExact(built);
  const double most = 2 * LargestRadiance(*built.scene);
  tally.counts["points"] += values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ExactValue& v = values[i];
    for (const Spectrum* s :
         {&v.irradiance, &v.gradient, &v.hessian, &v.irradiance_error, &v.gradient_error, &v.hessian_error}) {
      if (!std::isfinite((*s)[0])) return Text("point ", i, ": a value is ", (*s)[0]);
    }
    if (v.irradiance[0] < 0) return Text("point ", i, ": irradiance ", v.irradiance[0]);
    if (v.irradiance[0] > most + v.irradiance_error[0]) {
      return Text("point ", i, ": irradiance ", v.irradiance[0], " of at most ", most);
    }
    if (v.irradiance_error[0] < 0 || v.gradient_error[0] < 0 || v.hessian_error[0] < 0) {
      return Text("point ", i, ": a bound below 0");
    }
  }
  return std::nullopt;
}

Failure CheckTree(const SceneDescription& description, std::uint64_t seed, Tally& tally) {
  const Built built(description);
  if (!built.scene || built.scene->elements().empty()) return std::nullopt;
  Random random(seed);
  std::vector<Ray> batch;
  std::vector<std::optional<Hit>> hits;
  const int rays = built.scene->elements().size() > 200 ? 30 : 60;
  for (int i = 0; i < rays; ++i) {
    const SurfacePoint from = AnyPlace(built, random);
    const Vector2 direction = AnyDirection(built, from, random);
    const std::optional<Hit> hit = built.caster->ClosestHit(from, direction);
    batch.push_back({from, direction});
    hits.push_back(hit);
    const std::optional<BruteHit> brute = BruteClosestHit(*built.scene, from, direction);
    const std::string where =
        Text("from (", from.position.x, ", ", from.position.y, ") element ", static_cast<std::uint32_t>(from.element),
             " along (", direction.x, ", ", direction.y, "): ");
    if (hit.has_value() != brute.has_value() ||
        (hit && (hit->distance != brute->distance || hit->element != brute->element))) {
      return where + "the tree finds " + Describe(hit) + ", brute force " +
             (brute ? Text("element ", static_cast<std::uint32_t>(brute->element), " at ", brute->distance)
                    : "nothing");
    }
    if (hit && !(std::isfinite(hit->position.x) && std::isfinite(hit->position.y) && std::isfinite(hit->normal.x) &&
                 std::isfinite(hit->normal.y))) {
      return where + "a hit that is no place";
    }
    SurfacePoint to = random.Chance(0.3) && hit ? SurfacePoint{hit->position, hit->element} : AnyPlace(built, random);
    if (to.position == from.position) continue;
    const bool visible = built.caster->Visible(from, to);
    if (visible != BruteVisible(*built.scene, from, to)) {
      return Text(where, "the tree says that (", to.position.x, ", ", to.position.y, ") element ",
                  static_cast<std::uint32_t>(to.element), visible ? " is visible" : " is hidden",
                  ", brute force does not");
    }
    if (built.caster->Touches(from) != BruteTouches(*built.scene, from)) return where + "Touches differs";
    tally.counts["rays"] += 3;
  }
  // In a batch the same.
  std::vector<std::optional<Hit>> together(batch.size());
  built.caster->ClosestHits(batch, together);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (together[i].has_value() != hits[i].has_value() ||
        (hits[i] && (together[i]->distance != hits[i]->distance || together[i]->element != hits[i]->element))) {
      return Text("ray ", i, " alone finds ", Describe(hits[i]), ", in a batch ", Describe(together[i]));
    }
  }
  return std::nullopt;
}

}  // namespace flatlight::stress
