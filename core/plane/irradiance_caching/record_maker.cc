// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/record_maker.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/plane/irradiance_caching/break_series.h"
#include "core/plane/ray_tracing/formulations.h"
#include "core/plane/ray_tracing/hemicircle_gather.h"
#include "core/sampling/hash.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

constexpr int kDistanceRays = 64;
// Doubt is smooth: a part of the rays tell it.
constexpr std::uint32_t kDoubtShare = 8, kFewestDoubts = 16;
// The fourth derivative of what rays bring is noise.
constexpr std::size_t kKnownOfRays = 4;

// The mean of 1/r over the hemicircle, weighed by the cosine: at directions of equal steps of their sine.
double InverseDistance(const RayCaster& caster, const Receiver& receiver) {
  double sum = 0;
  for (int k = 0; k < kDistanceRays; ++k) {
    const double sine = (2 * k + 1.0) / kDistanceRays - 1;
    const Vector2 direction = sine * receiver.tangent + std::sqrt(1 - sine * sine) * receiver.normal;
    if (const auto hit = caster.ClosestHit({receiver.position, receiver.element}, direction)) sum += 1 / hit->distance;
  }
  return sum / kDistanceRays;
}

}  // namespace

RecordMaker::RecordMaker(const RayCaster& caster, const std::vector<Chart>& charts, const RayTree* tree,
                         const RecordMakerOptions& options)
    : caster_(caster),
      tree_(tree),
      options_(options),
      reflected_(options.reflected
                     ? std::optional<ReflectedSeries>(std::in_place, caster.scene(), charts, *options.reflected)
                     : std::nullopt),
      skyline_(caster, charts, options.reflected || options.rays > 0, reflected_ ? &*reflected_ : nullptr) {}

CacheRecord RecordMaker::Make(const Track& track, std::uint32_t index, double at, std::uint32_t wave,
                              const Cancellation& cancellation, double& cast) {
  CacheRecord record;
  record.track = index;
  record.at = at;
  record.wave = wave;
  const Receiver receiver = track.At(at);
  skyline_.LookFrom(receiver);
  record.derivative = skyline_.Irradiance();
  record.known = kRecordOrders;
  skyline_.Survey(record.surroundings);
  if (options_.control == ErrorControl::kSplitSphere || options_.control == ErrorControl::kBoundedSplitSphere) {
    record.surroundings.inverse_distance = InverseDistance(caster_, receiver);
    cast += kDistanceRays;
  }
  record.noise = options_.reflected_error * record.Irradiance();
  if (options_.rays > 0 && !reflected_) {
    std::uint64_t key = options_.key;
    for (const std::uint64_t part : {std::uint64_t{index}, std::bit_cast<std::uint64_t>(at)}) key = ChildKey(key, part);
    AddReflected(receiver, key, cancellation, record, cast);
  }
  return record;
}

void RecordMaker::AddReflected(const Receiver& receiver, std::uint64_t key, const Cancellation& cancellation,
                               CacheRecord& record, double& cast) const {
  const Scene& scene = caster_.scene();
  std::vector<GatheredRay> gathered;
  GatherHemicircle(*tree_, receiver, options_.rays, key, cancellation, gathered, cast);
  if (!cancellation.cancelled()) LookPastEnds(*tree_, receiver, options_.rays, key, cancellation, gathered, cast);
  if (cancellation.cancelled()) return;
  for (GatheredRay& ray : gathered) {
    // What comes straight from emitters is known better.
    ray.radiance = ray.radiance - EmittedToward(scene, receiver, ray);
    for (double& value : ray.radiance.value) value = std::max(value, 0.0);
  }
  record.known = kKnownOfRays;
  record.derivative[0] = record.derivative[0] + IrradianceOf(gathered);
  const Spectrum direct_gradient = record.derivative[1];
  Spectrum variance;
  for (std::size_t k = 1; k < gathered.size(); ++k) {
    const GatheredRay &before = gathered[k - 1], &after = gathered[k];
    Edge edge;
    edge.s = after.begin, edge.c = std::sqrt(std::max(0.0, 1 - after.begin * after.begin));
    edge.q = std::max(before.InverseDistance(), after.InverseDistance());
    const ArcSeries sine = SineSeries(after.break_before.value_or(edge), receiver);
    const Spectrum jump = before.radiance - after.radiance;
    for (std::size_t m = 1; m < kRecordOrders; ++m)
      record.derivative[m] = record.derivative[m] + sine.Derivative(m) * jump;
    // Of neighbours' difference half is each one's own noise; what it changes by counts with it.
    const double width = 0.5 * (after.end - after.begin + before.end - before.begin);
    variance = variance + (0.5 * width * width) * (jump * jump);
  }
  record.surroundings.radiometric = record.surroundings.radiometric + ArcLengthDerivatives(receiver, gathered).second;
  record.noise = std::sqrt(variance.Max());
  if (options_.doubt) {
    // All rays may end in the same photons: their errors add up.
    std::vector<GatheredRay> doubts;
    GatherHemicircle(*options_.doubt, receiver, std::max(options_.rays / kDoubtShare, kFewestDoubts), ChildKey(key, 0),
                     cancellation, doubts, cast);
    record.noise += IrradianceOf(doubts).Max();
  }
  // Of the order of the gradient, where something that reflects is covered or comes into sight.
  const Spectrum gradient = record.derivative[1] - direct_gradient;
  for (const double value : gradient.value) record.unknown_jump = std::max(record.unknown_jump, std::abs(value));
}

}  // namespace flatlight
