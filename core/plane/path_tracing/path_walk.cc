// SPDX-License-Identifier: Apache-2.0
// One path of the path tracer, from the receiver on.
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/math/check.h"
#include "core/math/trig.h"
#include "core/plane/materials/lossless.h"
#include "core/plane/path_tracing/path_tracer.h"

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

}  // namespace

template <int kChannels>
class PathWalk {
 public:
  PathWalk(const PathTracer& tracer, const SampleStream& stream, std::uint32_t index, double& rays)
      : tracer_(tracer), stream_(stream), index_(index), rays_(rays) {
    weight_.fill(1);
  }

  void Run(const PathTracer::Start& start, const Cancellation& cancellation) {
    const std::uint32_t last_depth = tracer_.MostBounces();
    vertex_ = start.vertex_;
    half_angle_ = start.half_angle_;
    for (std::uint32_t depth = 0; !cancellation.cancelled(); ++depth) {
      const SamplePair random = stream_.Pair(index_, depth);
      const EmitterSampler::View* view = nullptr;
      if (half_angle_ > 0) {
        // A pixel: what it shows is found by rays alone.
      } else if (scattering_ == nullptr) {
        view = depth == 0 ? &start.view_ : &Look(tracer_.sights_.FromElement(vertex_));
        GatherCertain(*view, random.u);
      } else if (!scattering_->specular()) {
        view = &Look({0, tracer_.sights_.FromElement(vertex_).hidden});
      }
      if (view != nullptr) {
        GatherLights(random.u);
        GatherChained(start, depth, last_depth - depth);
        GatherSampled(*view, random.u);
      }
      const bool last = depth == last_depth;
      if (last && !MayFindMore(view)) break;
      if (!Leave(random, depth)) break;
      ++rays_;
      const std::optional<Hit> hit = tracer_.caster_->ClosestHit(vertex_.at, direction_);
      if (!hit.has_value()) {
        Add(1, tracer_.scene_.environment());
        break;
      }
      Arrive(*hit, view);
      if (last || !Survive(depth)) break;
    }
  }

  const std::array<double, kChannels>& value() const { return value_; }

 private:
  const EmitterSampler::View& Look(const EmitterSight& sight) {
    view_.emplace(tracer_.emitters_, vertex_, sight);
    return *view_;
  }

  void Add(double factor, const Spectrum& light) {
    for (std::size_t c = 0; c < kChannels; ++c) value_[c] += weight_[c] * (factor * light.value[c]);
  }

  void GatherCertain(const EmitterSampler::View& view, double u) {
    if (!view.any_certain()) return;
    if (tracer_.options_.leave_out_shadow_rays) return Add(1, view.certain());
    // One by one: the sines of a piece at the horizon may be too close for a ray to tell.
    Spectrum proved;
    view.VisitCertain(u, [&](const SurfacePoint& point, const Spectrum& light) {
      ++rays_;
      if (tracer_.caster_->Visible(vertex_.at, point)) proved = proved + light;
    });
    Add(1, proved);
  }

  // What part of light from a direction goes the path's way: the cosine, or the BRDF and the cosine.
  Spectrum Response(Vector2 direction, double cosine) const {
    if (scattering_ == nullptr) return Spectrum::Grey(cosine);
    return cosine * scattering_->Value(out_, {Dot(vertex_.Tangent(), direction), cosine});
  }

  void GatherLights(double u) {
    tracer_.lights_.VisitUnblocked(vertex_, u, rays_, [&](const IncidentLight& light) {
      Add(1, Response(light.direction, light.cosine) * light.irradiance);
    });
  }

  void GatherChained(const PathTracer::Start& start, std::uint32_t depth, std::uint32_t most_links) {
    const ChainLights& chains = tracer_.chains_;
    if (chains.empty() || most_links == 0) return;
    const ChainEffort effort = depth == 0 ? ChainEffort::kFine : ChainEffort::kCoarse;
    chained_.clear();
    if (depth == 0) {
      chained_ = start.chained_;
    } else {
      chains.Find(effort, vertex_.at, vertex_.normal, most_links, rays_, chained_);
    }
    chains.FindByChance(effort, vertex_.at, vertex_.normal, most_links, stream_.Single(index_, depth + kChainNumber),
                        rays_, chained_);
    for (const ChainedLight& way : chained_)
      Add(1, Response(way.light.direction, way.light.cosine) * way.light.irradiance);
  }

  void GatherSampled(const EmitterSampler::View& view, double u) {
    if (view.empty()) return;
    const std::optional<EmitterSample> sample = view.Sample(u);
    if (!sample) return;
    const bool left_out = tracer_.options_.leave_out_shadow_rays && tracer_.options_.nothing_blocks;
    if (!left_out) ++rays_;
    if (!left_out && !tracer_.caster_->Visible(vertex_.at, sample->point)) return;
    if (scattering_ == nullptr) {
      const double share = view.sufficient() ? 1 : PowerHeuristic(sample->density, sample->cosine / 2);
      Add(share * (sample->cosine / sample->density), sample->radiance);
      return;
    }
    const Vector2 toward = sample->point.position - vertex_.at.position;
    const LocalDirection in{Dot(vertex_.Tangent(), toward) / Length(toward), sample->cosine};
    const double share = PowerHeuristic(sample->density, scattering_->Density(out_, in));
    Add(share * (sample->cosine / sample->density), scattering_->Value(out_, in) * sample->radiance);
  }

  // Whether a ray from the vertex can find light that is not counted yet, reflections aside.
  bool MayFindMore(const EmitterSampler::View* view) const {
    if (tracer_.scene_.traits().environment) return true;
    if (view == nullptr) return !tracer_.emitters_.empty();
    return !view->empty() && !(scattering_ == nullptr && view->sufficient());
  }

  // Chooses where to go. From here on weight_ counts radiance along the ray.
  bool Leave(const SamplePair& random, std::uint32_t depth) {
    if (half_angle_ > 0) {
      const SinCosValue turn = SinCos((2 * random.v - 1) * half_angle_);
      direction_ = vertex_.Direction(turn.sin, turn.cos);
      half_angle_ = 0;
      return true;
    }
    if (scattering_ == nullptr) {
      const double sine = 2 * random.v - 1;
      cosine_ = CosineOf(sine);
      density_ = cosine_ / 2;
      direction_ = vertex_.Direction(sine, cosine_);
      for (double& w : weight_) w *= 2;
      return true;
    }
    const std::optional<ScatterSample> sample =
        scattering_->Sample(out_, random.v, stream_.Single(index_, depth + kSecondNumber));
    if (!sample.has_value()) return false;
    cosine_ = sample->in.cosine;
    density_ = sample->density;
    direction_ = vertex_.Direction(sample->in.sine, cosine_);
    compression_ *= sample->compression;
    for (std::size_t c = 0; c < kChannels; ++c) weight_[c] *= sample->compression * sample->weight.value[c];
    return true;
  }

  // `view`: of the emitters that were sampled at the vertex behind; null if none were.
  void Arrive(const Hit& hit, const EmitterSampler::View* view) {
    const Element& element = tracer_.scene_.element(hit.element);
    const PathTracer::Surface& surface = tracer_.surfaces_[static_cast<std::size_t>(element.curve)];
    const bool front = Dot(hit.normal, direction_) < 0;
    const Spectrum& radiance = front ? surface.front_radiance : surface.back_radiance;
    if (!radiance.IsBlack()) {
      const double emitter_density = view == nullptr ? 0 : view->Density(hit, direction_, cosine_);
      if (emitter_density == 0) {
        Add(1, radiance);
      } else if (!(scattering_ == nullptr && view->sufficient()) && emitter_density < kInfinity) {
        Add(PowerHeuristic(density_, emitter_density), radiance);
      }
    }
    vertex_.at = {hit.position, hit.element};
    vertex_.normal = front ? hit.normal : -hit.normal;
    vertex_.carrier = element.carrier;
    if (surface.scattering == PathTracer::kLambertian) {
      scattering_ = nullptr;
      for (std::size_t c = 0; c < kChannels; ++c) weight_[c] *= 0.5 * surface.reflectance.value[c];
    } else {
      scattering_ = &tracer_.scatterings_[surface.scattering + (front ? 0 : 1)];
      out_ = {-Dot(vertex_.Tangent(), direction_), -Dot(vertex_.normal, direction_)};
    }
  }

  // Russian roulette.
  bool Survive(std::uint32_t depth) {
    // As irradiance, and as if there were no glass: compression by glass is undone on the way out.
    const double unit = (scattering_ == nullptr ? 1 : 0.5) / compression_;
    const double largest = unit * *std::max_element(weight_.begin(), weight_.end());
    if (largest == 0 && tracer_.options_.end_black_paths) return false;
    double survival = 1;
    if (largest < kLeastWeight) survival = largest == 0 ? 0.5 : largest / kLeastWeight;
    lossless_ = largest < last_largest_ ? 0 : lossless_ + 1;
    if (lossless_ > kMostLossless) survival *= kLosslessSurvival;
    last_largest_ = largest / survival;
    if (survival == 1) return true;
    if (stream_.Single(index_, depth) >= survival) return false;
    for (double& w : weight_) w /= survival;
    return true;
  }

  // Beyond all depths: tell the second number of a lobe and that of chains from that of roulette.
  static constexpr std::uint32_t kSecondNumber = 0x80000000;
  static constexpr std::uint32_t kChainNumber = 0xc0000000;

  const PathTracer& tracer_;
  const SampleStream& stream_;
  std::uint32_t index_;
  double& rays_;
  std::array<double, kChannels> value_{};
  // What light counts: irradiance at a vertex that gathers with the cosine, else radiance along the path.
  std::array<double, kChannels> weight_;
  Vertex vertex_;
  const Scattering* scattering_ = nullptr;  // Null at the receiver and on Lambertian curves.
  LocalDirection out_;                      // Of the path behind, at vertex_.
  Vector2 direction_;                       // Of the ray.
  double cosine_ = 0;                       // Of the ray where it leaves.
  double density_ = 0;                      // With which it was chosen, per radian; 0 if specular.
  double compression_ = 1;                  // Of radiance by all borders so far.
  double half_angle_ = 0;                   // Of the pixel that the path is to begin in; 0 once it has, or if in none.
  double last_largest_ = kInfinity;
  int lossless_ = 0;
  std::optional<EmitterSampler::View> view_;
  std::vector<ChainedLight> chained_;
};

void PathTracer::AddPath(const Start& start, const SampleStream& stream, std::uint32_t index,
                         const Cancellation& cancellation, std::span<double> irradiance, double& rays) const {
  FLATLIGHT_DCHECK(&start.tracer_ == this);
  const auto walk = [&](auto path) {
    path.Run(start, cancellation);
    for (std::size_t c = 0; c < irradiance.size(); ++c) irradiance[c] += path.value()[c];
  };
  if (channels_ == 1) {
    walk(PathWalk<1>(*this, stream, index, rays));
  } else {
    walk(PathWalk<kMaxChannels>(*this, stream, index, rays));
  }
}

}  // namespace flatlight
