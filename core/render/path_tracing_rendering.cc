// SPDX-License-Identifier: Apache-2.0
#include "core/render/path_tracing_rendering.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "core/plane/path_tracing/emitter_reach.h"
#include "core/plane/path_tracing/path_tracer.h"
#include "core/plane/ray_caster.h"
#include "core/render/light_paths.h"
#include "core/render/onward_points.h"
#include "core/render/probe_points.h"
#include "core/render/skips.h"

namespace flatlight {
namespace {

class PathSampler final : public PointSampler {
 public:
  PathSampler(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
              const PathTracingOptions& options, std::uint32_t seed)
      : scene_(std::move(scene)),
        caster_(std::move(caster)),
        tracer_(caster_, options),
        sights_(scene_->traits().probe_points),
        seed_(seed) {
    for (const Receiver* point : PointsOfProbes(*scene_)) {
      const OnwardPoint onward = MovedOnward(*point, *caster_);
      points_.push_back(onward.receiver);
      missed_.push_back(MissedAtHorizon(onward, *scene_));
    }
  }

  std::size_t channels() const override { return static_cast<std::size_t>(tracer_.channels()); }

  void Doubts(std::size_t point, std::span<Doubt> doubts) const override {
    const EmitterSight sight = SightFrom(point);
    const Spectrum step = tracer_.DirectStep(points_[point], sight);
    const Spectrum bright = tracer_.BrightestReflection();
    const Spectrum rounding =
        tracer_.DirectRounding(points_[point], sight) + missed_[point] * tracer_.BrightestEmission();
    for (std::size_t c = 0; c < doubts.size(); ++c) doubts[c] = {step.value[c], bright.value[c], rounding.value[c]};
  }

  std::unique_ptr<const Source> At(std::size_t point) const override { return std::make_unique<Paths>(*this, point); }

 private:
  class Paths final : public Source {
   public:
    Paths(const PathSampler& sampler, std::size_t point)
        : sampler_(sampler), start_(sampler.tracer_, sampler.points_[point], sampler.SightFrom(point)) {
      static_assert(kHalfReplicates == SampleStream::kMembers);
      for (std::uint32_t replicate = 0; replicate < kReplicates; ++replicate)
        streams_.push_back(SampleStream::Member(sampler.seed_, point, replicate / SampleStream::kMembers,
                                                replicate % SampleStream::kMembers));
    }

    void AddBlock(std::uint32_t block, const Cancellation& cancellation, std::span<double> sums,
                  double& rays) const override {
      const std::size_t channels = sampler_.channels();
      std::array<double, kMaxChannels> value{};
      for (std::size_t replicate = 0; replicate < kReplicates; ++replicate) {
        value.fill(0);
        sampler_.tracer_.AddPath(start_, streams_[replicate], block, cancellation, std::span(value).first(channels),
                                 rays);
        for (std::size_t c = 0; c < channels; ++c) sums[c * kReplicates + replicate] += value[c];
      }
    }

   private:
    const PathSampler& sampler_;
    PathTracer::Start start_;
    std::vector<SampleStream> streams_;
  };

  EmitterSight SightFrom(std::size_t point) const {
    return sights_.At(point, [&] { return tracer_.SightFrom(points_[point]); });
  }

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const RayCaster> caster_;
  std::vector<Receiver> points_;
  std::vector<double> missed_;  // By point: MissedAtHorizon.
  PathTracer tracer_;
  EmitterSightMemory sights_;  // By point.
  std::uint32_t seed_;
};

// No emitter, no light.
class DarkSampler final : public PointSampler {
 public:
  std::size_t channels() const override { return 1; }
  void Doubts(std::size_t, std::span<Doubt> doubts) const override { doubts[0] = {}; }
  std::unique_ptr<const Source> At(std::size_t) const override { return std::make_unique<Nothing>(); }

 private:
  class Nothing final : public Source {
    void AddBlock(std::uint32_t, const Cancellation&, std::span<double>, double&) const override {}
  };
};

std::unique_ptr<const PointSampler> MakeSampler(std::shared_ptr<const Scene> scene,
                                                std::shared_ptr<const RayCaster> caster, const Plan& plan) {
  if (plan.Takes(skip::kEmission)) return std::make_unique<DarkSampler>();
  PathTracingOptions options;
  options.max_bounces = plan.settings.max_bounces;
  if (plan.Takes(skip::kBounces)) options.max_bounces = 0;
  options.one_channel = plan.Takes(skip::kColour);
  options.leave_out_shadow_rays = plan.Takes(skip::kVisibility);
  options.nothing_blocks = NothingBlocks(*scene);
  options.end_black_paths = plan.Takes(skip::kBlackPaths);
  const EmitterReach reach = ReachOfEmitters(*scene);
  const SceneTraits& traits = scene->traits();
  options.nothing_reflects = traits.lights == 0 && !traits.environment && !reach.LightsReflectors();
  if (plan.Takes(skip::kUnseenEmitters)) {
    const bool direct = DirectLightOnly(*scene, plan.settings);
    for (const EmitterReach::Piece& piece : reach.pieces)
      if (!EmitterReach::Counts(piece, direct)) options.unseen_emitters.push_back(piece.id);
  }
  return std::make_unique<PathSampler>(std::move(scene), std::move(caster), options, plan.settings.seed.value_or(0));
}

SamplingGoal GoalOf(const Plan& plan) {
  SamplingGoal goal;
  goal.samples = plan.settings.samples;
  goal.target_error = plan.settings.target_error;
  goal.time_limit = plan.settings.time_limit;
  goal.skip_converged = !plan.Disables(skip::kConvergedPoints);
  return goal;
}

}  // namespace

PathTracingRendering::PathTracingRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                                           const Plan& plan)
    : scene_(std::move(scene)),
      max_threads_(plan.MaxThreads()),
      sampling_(MakeSampler(scene_, std::move(caster), plan), EndsOfProbes(*scene_), GoalOf(plan)) {}

void PathTracingRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                                   Clock::Duration budget) {
  sampling_.Advance(executor, max_threads_, cancellation, clock, budget);
}

std::shared_ptr<const Field> PathTracingRendering::Snapshot() const {
  auto field = std::make_shared<Field>();
  field->rays = sampling_.rays();
  const auto channels = static_cast<std::size_t>(scene_->channels());
  const double scale = scene_->frame().radiance_scale;
  // Rays meet the arcs that follow Béziers: where there is hardly any noise, that counts. It moves the directions of a
  // lamp's ends, which tells more of a lamp low above the horizon than that one gives.
  const double followed = scene_->bezier_distance();
  Spectrum brightest = scene_->environment();
  for (const Curve& curve : scene_->curves())
    for (int c = 0; c < kMaxChannels; ++c) brightest[c] = std::max(brightest[c], curve.radiance[c]);
  const std::vector<ProgressiveSampling::PointValue> of_points = sampling_.Values();
  std::size_t point = 0;
  for (const Probe& probe : scene_->probes()) {
    ProbeField values;
    values.irradiance.reserve(probe.receivers.size() * channels);
    values.standard_error.reserve(probe.receivers.size() * channels);
    values.samples.reserve(probe.receivers.size());
    for (std::size_t i = 0; i < probe.receivers.size(); ++i, ++point) {
      const ProgressiveSampling::PointValue& value = of_points[point];
      values.samples.push_back(value.samples);
      for (std::size_t c = 0; c < channels; ++c) {
        MeanEstimate estimate;
        if (value.samples > 0) estimate = value.estimates[ComputedChannel(c, sampling_.channels())];
        values.irradiance.push_back(scale * estimate.mean);
        const double off = followed * std::max(estimate.mean, brightest[static_cast<int>(c)]);
        values.standard_error.push_back(value.samples > 0 ? scale * (estimate.StandardError() + off) : 0);
      }
    }
    field->probes.push_back(std::move(values));
  }
  return field;
}

}  // namespace flatlight
