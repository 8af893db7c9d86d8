// SPDX-License-Identifier: Apache-2.0
#include "core/render/photon_mapping_rendering.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "core/math/power.h"
#include "core/plane/box.h"
#include "core/plane/photon_mapping/width_choice.h"
#include "core/render/light_paths.h"
#include "core/render/onward_points.h"
#include "core/render/probe_points.h"
#include "core/render/skips.h"
#include "core/render/state_stream.h"
#include "core/sampling/hash.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

using Seconds = std::chrono::duration<double>;

// A first pass of so many photons shows soon what is to come, where there are many more.
constexpr std::uint64_t kFirstPhotons = 4096;
// A pass that a time limit cuts short is lost, so none takes long then.
constexpr std::uint64_t kMostTimedPhotons = 1 << 16;
constexpr std::uint64_t kMostPhotons = std::uint64_t{kReplicates} << 32;  // Numbers of paths have 32 bits.
constexpr std::uint32_t kAnyBounces = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kFewestRays = 4;  // Of a replicate's gather.
constexpr std::uint32_t kMostRays = 1 << 12;
// Where there are more, fewer widths are kept for each: some 10 kB a point otherwise.
constexpr std::size_t kManyPoints = 1 << 16;
// The bias of a gather is small and smooth: a part of the rays tell it.
constexpr std::uint32_t kBiasShare = 4;

Box Around(const Scene& scene) {
  Box box;
  box.Add(Point2{});
  for (const Probe& probe : scene.probes()) {
    for (const Receiver& receiver : probe.receivers) box.Add(receiver.position);
  }
  return box;
}

// Of what a ray may find beyond the curve that it meets first.
double BrightestBeyond(const Scene& scene) {
  const bool beyond = std::any_of(scene.curves().begin(), scene.curves().end(), [](const Curve& curve) {
    return !std::holds_alternative<Lambertian>(curve.material) && !curve.reflectance.IsBlack();
  });
  if (!beyond) return 0;
  double brightest = scene.environment().Max();
  for (const Curve& curve : scene.curves()) brightest = std::max(brightest, curve.radiance.Max());
  return brightest;
}

double LargestReflectance(const Scene& scene) { return scene.traits().max_reflectance; }

}  // namespace

PhotonMappingRendering::PhotonMappingRendering(std::shared_ptr<const Scene> scene,
                                               std::shared_ptr<const RayCaster> caster, const Plan& plan)
    : scene_(std::move(scene)),
      caster_(std::move(caster)),
      settings_(plan.settings),
      gathers_(*plan.settings.final_gather),
      derivatives_(static_cast<int>(plan.settings.derivatives.value_or(Derivatives::kNone))),
      channels_(static_cast<std::size_t>(scene_->channels())),
      quantities_(derivatives_ > 0 ? kQuantities : kGradient),
      max_threads_(plan.MaxThreads()),
      key_(ChildKey(0, plan.settings.seed.value_or(0))) {
  std::size_t probe = 0;
  for (const std::size_t end : EndsOfProbes(*scene_)) {
    while (probe_of_point_.size() < end) probe_of_point_.push_back(probe);
    ++probe;
  }
  for (const Receiver* receiver : PointsOfProbes(*scene_)) points_.emplace_back().receiver = receiver;
  if (plan.Takes(skip::kEmission)) {
    end_reason_ = EndReason::kSamplesDone;
    return;
  }
  reflects_ = !DirectLightOnly(*scene_, settings_) && !plan.Takes(skip::kBounces);
  brightest_ = BrightestBeyond(*scene_);
  density_.kernel = settings_.kernel.value_or(gathers_ ? Kernel::kBox : Kernel::kEpanechnikov);
  if (settings_.bandwidth) density_.bandwidth = *settings_.bandwidth / scene_->frame().scale;
  if (settings_.neighbours) density_.neighbours = *settings_.neighbours;
  if (gathers_) {
    exact_.derivatives = derivatives_;
    if (scene_->traits().lights > 0) lights_.emplace(*caster_, exact_);
    direct_ = OrderedWork(points_.size());
    if (reflects_) {
      RayTreeOptions options;
      options.max_bounces = settings_.max_bounces;
      options.end_black_paths = plan.Takes(skip::kBlackPaths);
      tree_.emplace(caster_, options);
      for (const Point& point : points_) gather_from_.push_back(MovedOnward(*point.receiver, *caster_).receiver);
    }
  }
  if (gathers_ && !reflects_) return;
  // Directions and places of the world of the caster's scene; the probes are of this one.
  stretches_.emplace(caster_->scene());
  for (Point& point : points_) {
    const Receiver& receiver = *point.receiver;
    if (receiver.element == ElementId::kNone) continue;
    const Element& element = scene_->element(receiver.element);
    const Side side = Dot(FrontNormal(element, receiver.position), receiver.normal) > 0 ? Side::kFront : Side::kBack;
    point.place = stretches_->Locate(receiver.element, receiver.position, side);
  }
  chooses_widths_ = !gathers_ && !settings_.bandwidth && !settings_.neighbours;
  if (chooses_widths_) quantities_ = points_.size() <= kManyPoints ? kWidths : kFewWidths;
  const PhotonPurpose purpose = gathers_ ? PhotonPurpose::kReflectors : PhotonPurpose::kProbes;
  std::optional<std::uint32_t> most_bounces = settings_.max_bounces;
  if (!reflects_) most_bounces = 0;
  // What a gather finds is reflected once more.
  std::optional<std::uint32_t> traced = most_bounces;
  if (traced && gathers_) --*traced;
  light_.emplace(caster_, Around(*scene_), traced, kLeastPhotonShare);
  if (light_->sources().empty()) {
    light_.reset();
    return;
  }
  tracer_.emplace(*light_, caster_->scene(), *scene_, *stretches_, purpose,
                  most_bounces.value_or(std::numeric_limits<std::uint32_t>::max()));
  sums_.assign(points_.size() * kReplicates * quantities_ * channels_, 0);
  next_ = sums_;
  cast_.assign(points_.size(), 0);
  BeginPass();
}

std::uint64_t PhotonMappingRendering::AllPhotons() const {
  return settings_.photons ? std::max<std::uint64_t>(*settings_.photons, kReplicates) : kMostPhotons;
}

void PhotonMappingRendering::BeginPass() {
  pass_ = {};
  const std::uint64_t all = AllPhotons();
  const std::uint64_t done = photons_done_;
  std::uint64_t count;
  if (done == 0) {
    count = kFirstPhotons;
    if (!OpenEnded() && all < 4 * kFirstPhotons) count = all;
  } else if (OpenEnded()) {
    count = done;
  } else {
    const std::uint64_t passes = (all - done + kMostPassPhotons - 1) / kMostPassPhotons;
    count = (all - done + passes - 1) / passes;
  }
  count = std::min({count, all - done, settings_.time_limit ? kMostTimedPhotons : kMostPassPhotons});
  const double of = static_cast<double>(count) / static_cast<double>(OpenEnded() ? kFirstPhotons : all);
  if (gathers_) {
    const double rays = std::ceil(*settings_.samples * of / kReplicates);
    pass_.rays = static_cast<std::uint32_t>(std::clamp(rays, double{kFewestRays}, double{kMostRays}));
    if (!OpenEnded()) pass_.rays = std::max(kFewestRays, static_cast<std::uint32_t>(rays));
  }
  pass_.trace = PhotonTrace(settings_.seed.value_or(0), done, done + count);
  pass_.look = OrderedWork(points_.size() * kReplicates);
}

void PhotonMappingRendering::AddChained(const Receiver& receiver, const std::vector<ChainedLight>& ways,
                                        Spectrum& irradiance, Spectrum& gradient) const {
  for (const ChainedLight& way : ways) {
    const Spectrum more = way.light.cosine * way.light.irradiance;
    irradiance = irradiance + more;
    if (derivatives_ > 0) gradient = gradient + tree_->chains().AlongReceiver(way, receiver)[1] * more;
  }
}

bool PhotonMappingRendering::FindDirect(std::size_t first, std::size_t last, const Cancellation& cancellation) {
  std::unique_ptr<ExactSolver> solver =
      solvers_.Take([&] { return std::make_unique<ExactSolver>(*scene_, caster_->bvh(), exact_); });
  std::size_t i = first;
  for (; i < last && !cancellation.cancelled(); ++i) {
    points_[i].direct = solver->Evaluate(*points_[i].receiver);
    if (lights_) lights_->Add(*points_[i].receiver, points_[i].direct);
    if (!tree_) continue;
    std::vector<ChainedLight> chained;
    points_[i].chain_rays = 0;
    tree_->chains().Find(ChainEffort::kFine, SurfacePoint{gather_from_[i].position, gather_from_[i].element},
                         gather_from_[i].normal, tree_->most_bounces(), points_[i].chain_rays, chained);
    AddChained(gather_from_[i], chained, points_[i].direct.irradiance, points_[i].direct.gradient);
  }
  solvers_.Return(std::move(solver));
  return i == last;
}

void PhotonMappingRendering::MakeMaps(Executor& executor, int threads) {
  TracedPhotons photons = pass_.trace.Take(executor, threads);
  rays_ += photons.rays;
  pass_rays_ += photons.rays;
  DensityOptions options = density_;
  options.chooses = !chooses_widths_;
  options.narrowing = UnitPower(
      static_cast<double>(pass_.trace.end() - pass_.trace.first()) / static_cast<double>(pass_.trace.end()), 0.2);
  pass_.maps =
      std::make_unique<PhotonMaps>(*stretches_, std::move(photons.photons), photons.paths, options, executor, threads);
  if (!gathers_) return;
  using Told = MapIrradiance::Quantity;
  pass_.known.reserve(2 * kReplicates);
  for (const Told told : {Told::kIrradiance, Told::kBias}) {
    for (std::size_t r = 0; r < kReplicates; ++r) {
      pass_.known.emplace_back(*pass_.maps, r, told);
      pass_.trees.push_back(
          tree_->EndedBy(pass_.known.back(), told == Told::kBias ? Emission::kLeftOut : Emission::kSeen));
    }
  }
}

bool PhotonMappingRendering::LookUp(std::size_t first, std::size_t last, const Cancellation& cancellation) {
  for (std::size_t i = first; i < last; ++i)
    if (!LookUpAt(i / kReplicates, i % kReplicates, cancellation)) return false;
  return true;
}

bool PhotonMappingRendering::LookUpAt(std::size_t number, std::size_t r, const Cancellation& cancellation) {
  Point& point = points_[number];
  const auto keep = [&](std::size_t quantity, const Spectrum& kept) {
    for (std::size_t c = 0; c < channels_; ++c) next_[Index(number, r, quantity) + c] = kept[static_cast<int>(c)];
  };
  if (chooses_widths_) {
    const double widest = pass_.maps->Widest(point.place);
    double width = widest;
    for (std::size_t j = 0; j < quantities_; ++j, width /= WidthLadder::kRatio)
      keep(j, pass_.maps->Density(r, pass_.maps->WindowOf(point.place, width), PhotonMaps::Width::kFirst, kAnyBounces));
    if (r == 0) point.widest = widest;
    return true;
  }
  std::array<Spectrum, kQuantities> value;
  double step = 0, cast = 0;
  if (gathers_) {
    std::uint64_t key = key_;
    for (const std::uint64_t part : {std::uint64_t{number}, std::uint64_t{r}, pass_.trace.first()})
      key = ChildKey(key, part);
    const GatherGradient gradient = derivatives_ > 0 ? GatherGradient::kFound : GatherGradient::kLeftOut;
    const GatheredLight light =
        GatherReflected(pass_.trees[r], gather_from_[number], pass_.rays, key, gradient, cancellation);
    const std::uint32_t bias_rays = std::max(pass_.rays / kBiasShare, kFewestRays);
    const GatheredLight bias = GatherReflected(pass_.trees[kReplicates + r], gather_from_[number], bias_rays,
                                               ChildKey(key, 0), gradient, cancellation);
    if (!light.whole || !bias.whole) return false;
    value = {light.irradiance, bias.irradiance, light.gradient, bias.gradient, light.gradient_bias};
    cast = light.cast + bias.cast;
    std::vector<ChainedLight> chained;
    tree_->chains().FindByChance(ChainEffort::kFine, {gather_from_[number].position, gather_from_[number].element},
                                 gather_from_[number].normal, tree_->most_bounces(), ToUnitInterval(ChildKey(key, 1)),
                                 cast, chained);
    AddChained(gather_from_[number], chained, value[kIrradiance], value[kGradient]);
    // Of one photon more that is reflected somewhere.
    step = 0.5 * LargestReflectance(*scene_) * light.inverse_distance;
  }
  if (!gathers_ && point.receiver->element != ElementId::kNone) {
    const DensityWindow window = pass_.maps->WindowAt(point.place);
    value[kIrradiance] = value[kIrradiance] + pass_.maps->Density(r, window, PhotonMaps::Width::kFirst, kAnyBounces);
    value[kBias] = value[kBias] + pass_.maps->Bias(r, window, kAnyBounces);
    step = std::max(step, 0.5 / window.width);
  }
  for (std::size_t q = 0; q < quantities_; ++q) keep(q, value[q]);
  // Each of them is worked on by one thread at a time or by none: the first replicate speaks for all.
  if (r == 0) point.next_step = step, cast_[number] = cast * kReplicates;
  return true;
}

void PhotonMappingRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                                     Clock::Duration budget) {
  if (done()) return;
  const Clock::Time begin = clock.Now();
  if (!start_) start_ = begin - Clock::Duration(resumed_.value_or(0));
  resumed_.reset();
  const double seconds_before = seconds_;
  const int threads = std::max(std::min(max_threads_, executor.threads()), 1);
  while (!done() && !cancellation.cancelled()) {
    const Clock::Duration left = std::max(budget - (clock.Now() - begin), Clock::Duration(0));
    const auto advance = [&](OrderedWork& work, auto step) {
      work.Advance(executor, threads, cancellation, clock, left,
                   [&](std::size_t first, std::size_t last) { return (this->*step)(first, last, cancellation); });
    };
    if (!direct_.done()) {
      advance(direct_, &PhotonMappingRendering::FindDirect);
      if (direct_.done())
        for (const Point& point : points_) chain_rays_ += point.chain_rays;
    } else if (!tracer_) {
      end_reason_ = EndReason::kSamplesDone;
    } else if (!pass_.trace.done()) {
      pass_.trace.Advance(*tracer_, executor, threads, cancellation, clock, left);
      if (pass_.trace.done()) MakeMaps(executor, threads);
    } else {
      advance(pass_.look, &PhotonMappingRendering::LookUp);
      if (pass_.look.done()) EndPass(clock.Now());
    }
    const Clock::Time now = now_ = clock.Now();
    seconds_ = seconds_before + Seconds(now - begin).count();
    if (!done() && photons_done_ > 0 && settings_.time_limit && Seconds(now - *start_).count() >= *settings_.time_limit)
      end_reason_ = EndReason::kTimeLimit;
    if (now - begin >= budget) return;
  }
}

void PhotonMappingRendering::EndPass(Clock::Time now) {
  for (std::size_t point = 0; point < points_.size(); ++point) {
    for (std::size_t r = 0; r < kReplicates; ++r) {
      const auto paths = static_cast<double>(pass_.trace.paths(r));
      for (std::size_t i = Index(point, r, 0); i < Index(point, r, 0) + quantities_ * channels_; ++i)
        sums_[i] += paths * next_[i];
    }
    points_[point].step = points_[point].next_step;
    rays_ += cast_[point];
  }
  pass_rays_ = 0;
  photons_done_ = pass_.trace.end();
  gathered_rays_ += static_cast<double>(pass_.rays) * kReplicates;
  DecideEnd(now);
  if (!done()) BeginPass();
}

void PhotonMappingRendering::DecideEnd(Clock::Time now) {
  worst_error_ = WorstError();
  const std::uint64_t all = AllPhotons();
  // One decision for all points hardly biases any (THEORY 18 B12.3), and seldom ones are cheap.
  if (settings_.target_error && *worst_error_ <= *settings_.target_error) {
    end_reason_ = EndReason::kTargetReached;
  } else if (photons_done_ >= all) {
    end_reason_ = EndReason::kSamplesDone;
  } else if (settings_.time_limit && Seconds(now - *start_).count() >= *settings_.time_limit) {
    end_reason_ = EndReason::kTimeLimit;
  }
}

template <class Self, class Stream>
void PhotonMappingRendering::State(Self& self, Stream& stream) {
  stream.Filled(self.sums_);
  stream.Filled(self.points_);
  stream(self.photons_done_, self.gathered_rays_, self.worst_error_, self.seconds_);
}

std::string PhotonMappingRendering::Checkpoint(std::size_t most_bytes) const {
  if (!tracer_ || done() || photons_done_ == 0) return {};
  if (photons_done_ == resumed_photons_ && !resumed_) return {};
  StateWriter writer(most_bytes);
  writer(resumed_ ? *resumed_ : (now_ - *start_).count(), rays_ - pass_rays_);
  State(*this, writer);
  return writer.Take();
}

bool PhotonMappingRendering::Resume(std::string_view checkpoint) {
  if (!tracer_) return false;
  StateReader reader(checkpoint);
  reader(resumed_.emplace(), rays_);
  State(*this, reader);
  const std::uint64_t all = AllPhotons();
  reader.Require(photons_done_ > 0 && photons_done_ < all);
  if (!reader.AtEnd()) return false;
  resumed_photons_ = photons_done_;
  BeginPass();
  return true;
}

}  // namespace flatlight
