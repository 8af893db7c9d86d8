// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_tracing/ray_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "core/plane/materials/lossless.h"
#include "core/sampling/hash.h"

namespace flatlight {
namespace {

// Children of a vertex's key, beyond any number of rays.
constexpr std::uint64_t kRoulette = std::uint64_t{1} << 40;
constexpr std::uint64_t kLights = kRoulette + 1;
constexpr std::uint64_t kChains = kRoulette + 2;
constexpr std::uint64_t kSecondNumbers = kRoulette + 3;

double Number(std::uint64_t key, std::uint64_t child) { return ToUnitInterval(ChildKey(key, child)); }

}  // namespace

RayTree::RayTree(std::shared_ptr<const RayCaster> caster, const RayTreeOptions& options)
    : caster_(std::move(caster)),
      scene_(caster_->scene()),
      end_black_paths_(options.end_black_paths),
      most_bounces_(options.max_bounces.value_or(std::numeric_limits<std::uint32_t>::max())),
      lights_(*caster_),
      chains_(std::make_shared<const ChainLights>(*caster_, ChainOptions{.most_links = most_bounces_})) {
  auto surfaces = std::make_shared<std::vector<Surface>>();
  for (const Curve& curve : scene_.curves()) {
    Surface surface{curve.reflectance, curve.EmittedRadiance(Side::kFront), curve.EmittedRadiance(Side::kBack), {}, {}};
    if (!std::holds_alternative<Lambertian>(curve.material)) {
      surface.front.emplace(curve.material, Side::kFront);
      surface.back.emplace(curve.material, Side::kBack);
    }
    surfaces->push_back(surface);
  }
  surfaces_ = std::move(surfaces);
}

RayTree RayTree::EndedBy(const KnownIrradiance& known, Emission emission) const {
  RayTree ended = *this;
  ended.known_ = &known;
  ended.emission_ = emission;
  return ended;
}

std::uint32_t RayTree::Branches(std::uint32_t rays) {
  return std::max(1u, static_cast<std::uint32_t>(std::sqrt(static_cast<double>(rays))));
}

Spectrum RayTree::Radiance(const Hit& hit, Vector2 direction, std::uint32_t rays, std::uint64_t key,
                           const Cancellation& cancellation, double& cast) const {
  return Arriving(hit, direction, 0, Branches(rays), 0, key, {cancellation, cast});
}

Spectrum RayTree::Arriving(const Hit& hit, Vector2 direction, std::uint32_t depth, std::uint32_t branches, int lossless,
                           std::uint64_t key, const Growth& growth) const {
  const Element& element = scene_.element(hit.element);
  const Surface& surface = (*surfaces_)[static_cast<std::size_t>(element.curve)];
  const bool front = Dot(hit.normal, direction) < 0;
  Spectrum emitted;
  if (emission_ == Emission::kSeen) emitted = front ? surface.front_radiance : surface.back_radiance;
  if (depth == most_bounces_ || growth.cancellation.cancelled()) return emitted;
  if (end_black_paths_ && surface.reflectance.IsBlack()) return emitted;
  if (known_ != nullptr && !surface.front) {
    const Spectrum irradiance =
        known_->At({hit.position, hit.element}, front ? Side::kFront : Side::kBack, most_bounces_ - depth - 1);
    return emitted + 0.5 * surface.reflectance * irradiance;
  }
  Vertex vertex;
  vertex.at = {hit.position, hit.element};
  vertex.normal = front ? hit.normal : -hit.normal;
  vertex.carrier = element.carrier;
  const std::optional<Scattering>& scattering = front ? surface.front : surface.back;
  if (!scattering) return emitted + Diffuse(vertex, surface.reflectance, depth, branches, key, growth);
  const LocalDirection out{-Dot(vertex.Tangent(), direction), -Dot(vertex.normal, direction)};
  return emitted + Scattered(vertex, *scattering, out, depth, branches, lossless, key, growth);
}

Spectrum RayTree::Leaving(const Vertex& vertex, double sine, double cosine, std::uint32_t depth, std::uint32_t branches,
                          int lossless, std::uint64_t key, const Growth& growth) const {
  const Vector2 direction = vertex.Direction(sine, cosine);
  ++growth.cast;
  const std::optional<Hit> hit = caster_->ClosestHit(vertex.at, direction);
  return hit ? Arriving(*hit, direction, depth + 1, branches, lossless, key, growth) : Sky();
}

template <typename Visit>
void RayTree::VisitLights(const Vertex& vertex, std::uint32_t depth, std::uint64_t key, const Growth& growth,
                          Visit visit) const {
  lights_.VisitUnblocked(vertex, Number(key, kLights), growth.cast, visit);
  const std::uint32_t most_links = most_bounces_ - depth - 1;
  if (chains_->empty() || most_links == 0) return;
  std::vector<ChainedLight> chained;
  chains_->Find(ChainEffort::kCoarse, vertex.at, vertex.normal, most_links, growth.cast, chained);
  chains_->FindByChance(ChainEffort::kCoarse, vertex.at, vertex.normal, most_links, Number(key, kChains), growth.cast,
                        chained);
  for (const ChainedLight& way : chained) visit(way.light);
}

// The BRDF is reflectance / 2 and rays are uniform in the sine, with density cosine / 2: the mean of what they bring.
Spectrum RayTree::Diffuse(const Vertex& vertex, const Spectrum& reflectance, std::uint32_t depth,
                          std::uint32_t branches, std::uint64_t key, const Growth& growth) const {
  Spectrum mean;
  VisitLights(vertex, depth, key, growth,
              [&](const IncidentLight& light) { mean = mean + 0.5 * light.cosine * light.irradiance; });
  double survival = 1;
  if (branches == 1) {
    survival = reflectance.IsBlack() ? 0.5 : std::min(1.0, reflectance.Max());
    if (survival < 1 && Number(key, kRoulette) >= survival) return reflectance * mean;
  }
  Spectrum sum;
  for (std::uint32_t k = 0; k < branches; ++k) {
    const std::uint64_t child = ChildKey(key, k);
    const double sine = std::clamp(2 * ((k + ToUnitInterval(child)) / branches) - 1, -1.0, 1.0);
    sum = sum + Leaving(vertex, sine, CosineOf(sine), depth, Branches(branches), 0, ChildKey(child, 0), growth);
  }
  return reflectance * (mean + (1 / (survival * branches)) * sum);
}

Spectrum RayTree::Scattered(const Vertex& vertex, const Scattering& scattering, LocalDirection out, std::uint32_t depth,
                            std::uint32_t branches, int lossless, std::uint64_t key, const Growth& growth) const {
  Spectrum light;
  if (!scattering.specular() && emission_ == Emission::kSeen) {
    VisitLights(vertex, depth, key, growth, [&](const IncidentLight& incident) {
      const LocalDirection in{Dot(vertex.Tangent(), incident.direction), incident.cosine};
      light = light + incident.cosine * (scattering.Value(out, in) * incident.irradiance);
    });
  }
  // A mirror has one way on and glass has two; behind them the light branches as it would have here.
  const std::uint32_t rays = scattering.specular() ? std::min(branches, 2u) : branches;
  const std::uint32_t next = scattering.specular() ? std::max(branches / rays, 1u) : Branches(branches);
  Spectrum sum;
  for (std::uint32_t k = 0; k < rays; ++k) {
    const std::uint64_t child = ChildKey(key, k);
    const std::optional<ScatterSample> sample =
        scattering.Sample(out, (k + ToUnitInterval(child)) / rays, Number(key, kSecondNumbers + k));
    if (!sample) continue;
    double survival = next == 1 ? std::min(1.0, sample->weight.Max()) : 1;
    const int without_loss = sample->weight.Max() < 1 ? 0 : lossless + 1;
    if (without_loss > kMostLossless) survival *= kLosslessSurvival;
    if (survival < 1 && Number(child, kRoulette) >= survival) continue;
    const Spectrum radiance =
        Leaving(vertex, sample->in.sine, sample->in.cosine, depth, next, without_loss, ChildKey(child, 0), growth);
    sum = sum + (sample->compression / survival) * (sample->weight * radiance);
  }
  return light + (1.0 / rays) * sum;
}

}  // namespace flatlight
