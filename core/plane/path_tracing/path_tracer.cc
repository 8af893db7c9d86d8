// SPDX-License-Identifier: Apache-2.0
#include "core/plane/path_tracing/path_tracer.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "core/math/check.h"

namespace flatlight {
namespace {

// Paths that are lighter play roulette; survivors get this weight. Rooms of ordinary brightness keep their first
// reflections free of roulette's noise, and no path goes on for longer than its share of the light is worth. (Measured:
// docs/sampling.md.)
constexpr double kLeastWeight = 0.2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Weight of the first of two techniques.
double PowerHeuristic(double density, double other_density) {
  const double ratio = other_density / density;
  return 1 / (1 + ratio * ratio);
}

template <int kChannels>
double Largest(const std::array<double, kChannels>& weight) {
  return *std::max_element(weight.begin(), weight.end());
}

std::vector<ElementId> EmittingPieces(const RayCaster& caster, const PathTracingOptions& options) {
  const Scene& scene = caster.scene();
  const std::vector<ElementId>& unseen = options.unseen_emitters;
  std::vector<ElementId> pieces;
  for (const Curve& curve : scene.curves()) {
    if (!curve.Emits()) continue;
    for (std::uint32_t e = curve.first_element; e < curve.first_element + curve.element_count; ++e) {
      const ElementId id = static_cast<ElementId>(e);
      if (std::find(unseen.begin(), unseen.end(), id) == unseen.end()) pieces.push_back(id);
    }
  }
  return pieces;
}

}  // namespace

PathTracer::Start::Start(const PathTracer& tracer, const Receiver& receiver, const EmitterSight& sight)
    : tracer_(tracer), vertex_(VertexAt(tracer.scene_, receiver)), view_(tracer.emitters_, vertex_, sight) {
  view_.LookCloser();
}

PathTracer::PathTracer(std::shared_ptr<const RayCaster> caster, const PathTracingOptions& options)
    : caster_(std::move(caster)),
      scene_(caster_->scene()),
      options_(options),
      channels_(options.one_channel ? 1 : kMaxChannels),
      emitting_(EmittingPieces(*caster_, options)),
      emitters_(std::shared_ptr<const Scene>(caster_, &caster_->scene()), emitting_),
      sights_(*caster_, emitters_.weighs() ? emitting_ : std::vector<ElementId>()) {
  surfaces_.reserve(scene_.curves().size());
  for (const Curve& curve : scene_.curves()) {
    surfaces_.push_back({curve.reflectance, curve.EmittedRadiance(Side::kFront), curve.EmittedRadiance(Side::kBack)});
  }
}

Spectrum PathTracer::DirectStep(const Receiver& receiver, const EmitterSight& sight) const {
  return options_.nothing_blocks ? Spectrum{} : emitters_.Unblocked(VertexAt(scene_, receiver), sight);
}

Spectrum PathTracer::BrightestReflection() const {
  Spectrum bright;
  if (options_.max_bounces == 0u || options_.nothing_reflects || emitters_.empty()) return bright;
  Spectrum reflectance;
  for (const Curve& curve : scene_.curves()) {
    for (int c = 0; c < kMaxChannels; ++c) {
      bright[c] = std::max(bright[c], 2 * curve.radiance[c]);
      reflectance[c] = std::max(reflectance[c], curve.reflectance[c]);
    }
  }
  return bright * reflectance;
}

Spectrum PathTracer::DirectRounding(const Receiver& receiver, const EmitterSight& sight) const {
  return emitters_.Rounding(VertexAt(scene_, receiver), sight);
}

void PathTracer::AddPath(const Start& start, const SampleStream& stream, std::uint32_t index,
                         const Cancellation& cancellation, std::span<double> irradiance, double& rays) const {
  FLATLIGHT_DCHECK(&start.tracer_ == this);
  if (emitters_.empty()) return;
  if (channels_ == 1) {
    AddPathOf<1>(start, stream, index, cancellation, irradiance, rays);
  } else {
    AddPathOf<kMaxChannels>(start, stream, index, cancellation, irradiance, rays);
  }
}

template <int kChannels>
void PathTracer::AddPathOf(const Start& start, const SampleStream& stream, std::uint32_t index,
                           const Cancellation& cancellation, std::span<double> irradiance, double& rays) const {
  std::array<double, kChannels> value{};
  std::array<double, kChannels> weight;
  weight.fill(1);
  const auto add = [&](double factor, const Spectrum& radiance) {
    for (std::size_t c = 0; c < kChannels; ++c) value[c] += weight[c] * (factor * radiance.value[c]);
  };
  const std::uint32_t last_depth = options_.max_bounces.value_or(std::numeric_limits<std::uint32_t>::max());
  Vertex vertex = start.vertex_;
  std::optional<EmitterSampler::View> later_view;
  for (std::uint32_t depth = 0; !cancellation.cancelled(); ++depth) {
    const bool last = depth == last_depth;
    const SamplePair random = stream.Pair(index, depth);
    if (depth > 0) later_view.emplace(emitters_, vertex, sights_.FromElement(vertex));
    const EmitterSampler::View& view = depth == 0 ? start.view_ : *later_view;
    if (view.any_certain()) {
      bool proved = true;
      if (!options_.leave_out_shadow_rays) {
        view.VisitCertain(random.u, [&](const SurfacePoint& point) {
          ++rays;
          proved = proved && caster_->Visible(vertex.at, point);
        });
      }
      if (proved) add(1, view.certain());
    }
    if (!view.empty()) {
      if (const std::optional<EmitterSample> sample = view.Sample(random.u)) {
        const bool left_out = options_.leave_out_shadow_rays && options_.nothing_blocks;
        if (!left_out) ++rays;
        if (left_out || caster_->Visible(vertex.at, sample->point)) {
          const double share = view.sufficient() ? 1 : PowerHeuristic(sample->density, sample->cosine / 2);
          add(share * (sample->cosine / sample->density), sample->radiance);
        }
      }
    }
    // The last ray could only find emitters, and those are done with.
    if (last && (view.empty() || view.sufficient())) break;

    const double sine = 2 * random.v - 1;
    const double cosine = CosineOf(sine);
    const Vector2 direction = vertex.Direction(sine, cosine);
    ++rays;
    const std::optional<Hit> hit = caster_->ClosestHit(vertex.at, direction);
    if (!hit.has_value()) break;
    const Element& element = scene_.element(hit->element);
    const Surface& surface = surfaces_[static_cast<std::size_t>(element.curve)];
    const bool front = Dot(hit->normal, direction) < 0;
    const Spectrum& radiance = front ? surface.front_radiance : surface.back_radiance;
    if (!radiance.IsBlack()) {
      const double emitter_density = view.Density(*hit, direction, cosine);
      if (emitter_density == 0) {
        add(2, radiance);
      } else if (!view.sufficient() && emitter_density < kInfinity) {
        add(2 * PowerHeuristic(cosine / 2, emitter_density), radiance);
      }
    }
    if (last) break;

    for (std::size_t c = 0; c < kChannels; ++c) weight[c] *= surface.reflectance.value[c];
    const double largest = Largest<kChannels>(weight);
    if (largest == 0 && options_.end_black_paths) break;
    if (largest < kLeastWeight) {
      const double survival = largest == 0 ? 0.5 : largest / kLeastWeight;
      if (stream.Single(index, depth) >= survival) break;
      for (double& w : weight) w /= survival;
    }
    vertex.at = {hit->position, hit->element};
    vertex.normal = front ? hit->normal : -hit->normal;
    vertex.carrier = element.carrier;
  }
  for (std::size_t c = 0; c < kChannels; ++c) irradiance[c] += value[c];
}

}  // namespace flatlight
