// SPDX-License-Identifier: Apache-2.0
#include "core/plane/light_tracing/light_tracer.h"

#include <cmath>
#include <limits>

#include "core/plane/materials/lossless.h"

namespace flatlight {

LightTracer::LightTracer(std::shared_ptr<const RayCaster> caster, const Box& seen,
                         std::optional<std::uint32_t> max_bounces, double least_share)
    : caster_(std::move(caster)),
      scene_(caster_->scene()),
      most_bounces_(max_bounces.value_or(std::numeric_limits<std::uint32_t>::max())),
      least_share_(least_share),
      sources_(scene_, seen),
      far_(8 + 4 * Length(seen.high - Point2{}) + 4 * Length(seen.low - Point2{})) {
  for (const Curve& curve : scene_.curves()) {
    scatterings_.emplace_back(curve.material, Side::kFront);
    scatterings_.emplace_back(curve.material, Side::kBack);
  }
}

double LightTracer::AddPath(const SampleStream& stream, std::uint32_t index, std::span<FluenceImage> images) const {
  return Follow(stream, index, [&](const LightStep& step) {
    // From a light far away the way to the images may be long.
    const Point2 end = step.hit ? step.hit->position
                                : step.from.position + (far_ + Length(step.from.position - Point2{})) * step.direction;
    for (FluenceImage& image : images) image.AddLine(step.from.position, end, step.flux);
  });
}

bool LightTracer::Scatter(const Hit& hit, const SampleStream& stream, std::uint32_t index, std::uint32_t depth,
                          double least_flux, Vector2& direction, Spectrum& flux) const {
  const auto curve = static_cast<std::size_t>(scene_.element(hit.element).curve);
  const bool front = Dot(hit.normal, direction) < 0;
  const Vector2 normal = front ? hit.normal : -hit.normal;
  const LocalDirection arriving{-Dot(Right(normal), direction), -Dot(normal, direction)};
  const SamplePair random = stream.Pair(index, depth + 1);
  // Reciprocal: where light comes from that leaves along `arriving` is where light goes that comes from there.
  const std::optional<ScatterSample> sample =
      scatterings_[2 * curve + (front ? 0 : 1)].Sample(arriving, random.v, random.u);
  if (!sample.has_value()) return false;
  flux = sample->weight * flux;
  double survival = std::min(1.0, flux.Max() / least_flux);
  if (depth > std::uint32_t{kMostLossless}) survival = std::min(survival, kLosslessSurvival);
  if (stream.Single(index, depth) >= survival) return false;
  flux = (1 / survival) * flux;
  direction = Normalized(sample->in.sine * Right(normal) + sample->in.cosine * normal);
  return true;
}

}  // namespace flatlight
