// SPDX-License-Identifier: Apache-2.0
#include "core/render/ray_tracing_rendering.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/render/onward_points.h"
#include "core/render/probe_points.h"
#include "core/render/skips.h"
#include "core/render/state_stream.h"
#include "core/render/world_units.h"
#include "core/sampling/hash.h"
#include "core/statistics/misses_in_row.h"

namespace flatlight {
namespace {

using Seconds = std::chrono::duration<double>;

// With fewer, derivatives miss too much for the misses to be told from noise.
constexpr std::uint32_t kFirstRays = 16;
// Children of a gather's key, beyond those of its rays.
constexpr std::uint64_t kChains = std::uint64_t{1} << 43;
constexpr double kRoundSeconds = 4e-3;  // Of a thread, between two looks at the clock.
constexpr std::size_t kMostTasks = 1 << 14;
constexpr double kDarkest = 0.01;  // Errors count in this share of the probe's mean at least (DESIGN 3).

int OrdersOf(const Plan& plan) { return 1 + static_cast<int>(plan.settings.derivatives.value_or(Derivatives::kNone)); }

std::uint32_t RaysOfReplicate(std::uint32_t samples) {
  return std::max(kFirstRays,
                  (samples + static_cast<std::uint32_t>(kReplicates) - 1) / static_cast<std::uint32_t>(kReplicates));
}

double BrightestOf(const Scene& scene) {
  double brightest = scene.environment().Max();
  for (const Curve& curve : scene.curves()) brightest = std::max(brightest, curve.radiance.Max());
  return brightest;
}

GatherDerivatives DerivativesBy(Formulation formulation, const Receiver& receiver,
                                const std::vector<GatheredRay>& gathered) {
  switch (formulation) {
    case Formulation::kArcLength:
      return ArcLengthDerivatives(receiver, gathered);
    case Formulation::kPolyline:
      return PolylineDerivatives(receiver, gathered);
    default:
      return StratifiedDerivatives(receiver, gathered);
  }
}

}  // namespace

RayTracingRendering::RayTracingRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                                         const Plan& plan)
    : scene_(std::move(scene)),
      settings_(plan.settings),
      orders_(OrdersOf(plan)),
      max_threads_(plan.MaxThreads()),
      brightest_(BrightestOf(*scene_)) {
  std::size_t probe = 0;
  for (const std::size_t end : EndsOfProbes(*scene_)) {
    while (probe_of_point_.size() < end) probe_of_point_.push_back(probe);
    ++probe;
  }
  estimates_.resize(probe_of_point_.size());
  decisions_.resize(probe_of_point_.size(), Decision::kOpen);
  if (settings_.samples.has_value()) last_rays_ = RaysOfReplicate(*settings_.samples);
  if (plan.Takes(skip::kEmission)) {
    for (Estimate& estimate : estimates_) estimate.rays = last_rays_;
    end_reason_ = EndReason::kSamplesDone;
    return;
  }
  RayTreeOptions options;
  options.max_bounces = settings_.max_bounces;
  if (plan.Takes(skip::kBounces)) options.max_bounces = 0;
  options.end_black_paths = plan.Takes(skip::kBlackPaths);
  ExactOptions exact;
  exact.derivatives = orders_ - 1;
  for (const Receiver* point : PointsOfProbes(*scene_)) {
    const OnwardPoint onward = MovedOnward(*point, *caster);
    points_.push_back(onward.receiver);
    missed_.push_back(MissedAtHorizon(onward, *scene_));
  }
  tree_.emplace(std::move(caster), options);
  if (scene_->traits().lights > 0) lights_.emplace(tree_->caster(), exact);
  BeginPass(last_rays_ > 0 ? std::min(kFirstRays, last_rays_) : kFirstRays);
}

void RayTracingRendering::BeginPass(std::uint32_t rays) {
  pass_rays_ = rays;
  pass_.clear();
  next_task_ = 0;
  for (std::size_t point = 0; point < points_.size(); ++point)
    if (decisions_[point] != Decision::kFinal) pass_.push_back(point);
}

RayTracingRendering::Gathered RayTracingRendering::Gather(std::size_t point, std::size_t replicate,
                                                          const Cancellation& cancellation) const {
  std::vector<GatheredRay> gathered;
  gathered.reserve(pass_rays_ + std::size_t{1});
  const Receiver& receiver = points_[point];
  std::uint64_t key = ChildKey(0, settings_.seed.value_or(0));
  for (const std::uint64_t part : {std::uint64_t{point}, std::uint64_t{replicate}, std::uint64_t{pass_rays_}}) {
    key = ChildKey(key, part);
  }
  Gathered result;
  GatherHemicircle(*tree_, receiver, pass_rays_, key, cancellation, gathered, result.cast);
  if (cancellation.cancelled()) return result;
  result.whole = true;
  result.value[0] = IrradianceOf(gathered);
  if (orders_ > 1) {
    result.value[kRotation] = RotationOf(*tree_, receiver, pass_rays_, key, cancellation, gathered, result.cast);
    result.whole = !cancellation.cancelled();
    const Formulation formulation = settings_.formulation.value_or(Formulation::kStratified);
    if (formulation != Formulation::kArcLength) {
      LookPastEnds(*tree_, receiver, pass_rays_, key, cancellation, gathered, result.cast);
      result.whole = !cancellation.cancelled();
    }
    // A hollow receiver is near to itself, but hides nothing there.
    for (const GatheredRay& ray : gathered) {
      if (ray.element != receiver.element) result.steepest = std::max(result.steepest, ray.InverseDistance());
    }
    const GatherDerivatives derivatives = DerivativesBy(formulation, receiver, gathered);
    result.value[1] = derivatives.first;
    result.value[2] = derivatives.second;
  }
  std::vector<ChainedLight> chained;
  tree_->chains().FindByChance(ChainEffort::kFine, {receiver.position, receiver.element}, receiver.normal,
                               tree_->most_bounces(), ToUnitInterval(ChildKey(key, kChains)), result.cast, chained);
  AddChained(receiver, chained, result.value);
  return result;
}

void RayTracingRendering::AddChained(const Receiver& receiver, const std::vector<ChainedLight>& ways,
                                     std::array<Spectrum, kQuantities>& value) const {
  for (const ChainedLight& way : ways) {
    const Spectrum irradiance = way.light.cosine * way.light.irradiance;
    value[0] = value[0] + irradiance;
    if (orders_ == 1) continue;
    const Series<4> along = tree_->chains().AlongReceiver(way, receiver);
    value[1] = value[1] + along[1] * irradiance;
    value[2] = value[2] + along.Derivative(2) * irradiance;
    value[kRotation] = value[kRotation] + Dot(way.light.direction, receiver.tangent) * way.light.irradiance;
  }
}

void RayTracingRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                                  Clock::Duration budget) {
  const Clock::Time begin = clock.Now();
  if (!start_) start_ = begin - Clock::Duration(resumed_.value_or(0));
  const double seconds_before = seconds_;
  const int threads = std::max(std::min(max_threads_, executor.threads()), 1);
  while (!done() && !cancellation.cancelled()) {
    const Clock::Time before = clock.Now();
    const double seconds = std::min(kRoundSeconds * threads, std::max(Seconds(budget - (before - begin)).count(), 0.0));
    const std::size_t left = pass_.size() * kReplicates - next_task_;
    const auto wanted = static_cast<std::size_t>(std::min(tasks_per_second_ * seconds, double{kMostTasks}));
    const std::size_t tasks = std::min(std::max(wanted, static_cast<std::size_t>(threads)), left);
    // Some replicates of the first point may be there already.
    const std::size_t have = next_task_ % kReplicates;
    unfinished_.resize(have + tasks);
    executor.ParallelFor(tasks, threads, [&](std::size_t i) {
      const std::size_t task = next_task_ + i;
      unfinished_[have + i] = Gather(pass_[task / kReplicates], task % kReplicates, cancellation);
    });
    std::size_t whole = have;
    while (whole < unfinished_.size() && unfinished_[whole].whole) rays_ += unfinished_[whole++].cast;
    const std::size_t first = next_task_ / kReplicates, points = whole / kReplicates;
    for (std::size_t i = 0; i < points; ++i) FinishPoint(pass_[first + i], &unfinished_[i * kReplicates]);
    next_task_ += whole - have;
    work_done_ += static_cast<double>(whole - have) * pass_rays_;
    unfinished_.resize(whole);
    unfinished_.erase(unfinished_.begin(), unfinished_.begin() + static_cast<std::ptrdiff_t>(points * kReplicates));
    const Clock::Time after = clock.Now();
    now_ = after;
    const double spent = Seconds(after - before).count();
    tasks_per_second_ = spent > 0 ? static_cast<double>(tasks) / spent : double{kMostTasks};
    seconds_ = seconds_before + Seconds(after - begin).count();
    if (next_task_ == pass_.size() * kReplicates) {
      PlanPass(after);
    } else if (settings_.time_limit && Seconds(after - *start_).count() >= *settings_.time_limit) {
      end_reason_ = EndReason::kTimeLimit;
    }
    if (after - begin >= budget) return;
  }
}

void RayTracingRendering::FinishPoint(std::size_t point, const Gathered* gathered) {
  Estimate& estimate = estimates_[point];
  estimate = {};
  estimate.rays = pass_rays_;
  double steepest = 0;
  for (std::size_t r = 0; r < kReplicates; ++r) steepest = std::max(steepest, gathered[r].steepest);
  // What one ray more on the brightest thing changes, there where the nearest is.
  const double step = brightest_ * 2.0 / pass_rays_;
  estimate.step = {step, 2 * step * steepest, 6 * step * steepest * steepest, step};
  // Of light within an angle of the horizon irradiance has half the square, rotation the angle itself.
  const double missed = brightest_ * missed_[point];
  estimate.rounding = {missed, 2 * missed * steepest, 6 * missed * steepest * steepest,
                       brightest_ * std::sqrt(missed_[point])};
  std::array<double, kReplicates> values;
  for (std::size_t order = 0; order < kQuantities; ++order) {
    if (!Computes(static_cast<int>(order))) continue;
    for (int c = 0; c < kMaxChannels; ++c) {
      for (std::size_t r = 0; r < kReplicates; ++r) values[r] = gathered[r].value[order][c];
      estimate.spread[order][c] = HalvesSpreadOf(values);
      estimate.value[order][c] = estimate.spread[order][c].All().mean;
      if (order > 0) continue;
      const auto [least, most] = std::minmax_element(values.begin(), values.end());
      estimate.range[c] = *most - *least;
    }
  }
  if (!lights_) return;
  std::vector<ChainedLight> chained;
  const Receiver& receiver = points_[point];
  tree_->chains().Find(ChainEffort::kFine, {receiver.position, receiver.element}, receiver.normal,
                       tree_->most_bounces(), rays_, chained);
  AddChained(receiver, chained, estimate.value);
  ExactValue direct;
  lights_->Add(points_[point], direct);
  const std::array<const Spectrum*, kQuantities> light = {&direct.irradiance, &direct.gradient, &direct.hessian,
                                                          &direct.rotation};
  for (std::size_t order = 0; order < kQuantities; ++order) {
    if (Computes(static_cast<int>(order))) estimate.value[order] = estimate.value[order] + *light[order];
  }
}

std::vector<Spectrum> RayTracingRendering::MeansOverProbes() const {
  std::vector<Spectrum> means(scene_->probes().size());
  for (std::size_t point = 0; point < estimates_.size(); ++point) {
    const std::size_t probe = probe_of_point_[point];
    const double share = 1 / static_cast<double>(scene_->probes()[probe].receivers.size());
    means[probe] = means[probe] + share * estimates_[point].value[0];
  }
  return means;
}

std::vector<Spectrum> RayTracingRendering::Errors(std::size_t quantity) const {
  if (quantity == 0) return IrradianceErrors();
  std::vector<Spectrum> errors(estimates_.size());
  for (std::size_t point = 0; point < errors.size(); ++point) {
    const Estimate& estimate = estimates_[point];
    const Missable missable{estimate.step[quantity], estimate.step[quantity]};
    for (int c = 0; c < scene_->channels(); ++c) {
      if (estimate.spread[quantity][c].first.count == 0) continue;
      MeanEstimate mean = EstimateMean(estimate.spread[quantity][c].All(), missable);
      mean.rounding = estimate.rounding[quantity];
      errors[point][c] = mean.StandardError();
    }
  }
  return errors;
}

std::vector<Spectrum> RayTracingRendering::IrradianceErrors() const {
  std::vector<Spectrum> errors(estimates_.size());
  for (std::size_t point = 0; point < errors.size(); ++point)
    errors[point] = estimates_[point].error.value_or(Spectrum());
  for (int c = 0; c < scene_->channels(); ++c) {
    std::size_t first = 0;
    for (const Probe& probe : scene_->probes()) {
      const std::size_t size = probe.receivers.size();
      std::vector<std::optional<RowPoint>> row(size);
      for (std::size_t i = 0; i < size; ++i) {
        const Estimate& estimate = estimates_[first + i];
        if (estimate.error || estimate.spread[0][c].first.count == 0) continue;
        row[i] = {estimate.spread[0][c], {0, estimate.step[0]}, estimate.step[0]};
      }
      for (std::size_t i = 0; i < size; ++i) {
        if (!row[i]) continue;
        const auto [begin, end] = NeighboursInRow(i, size, kNeighbours);
        double count = 0;
        Missable& missable = row[i]->missable;
        for (std::size_t p = begin; p < end; ++p) {
          if (!row[p]) continue;
          ++count;
          missable.seen = std::max(missable.seen, estimates_[first + p].range[c]);
        }
        missable.seen = std::min(missable.seen, missable.largest);
        missable.share = 1 / std::sqrt(count);
      }
      const MissesInRow misses(row);
      for (std::size_t i = 0; i < size; ++i) {
        if (!row[i]) continue;
        NearbyVariance nearby;
        nearby.missed = misses.At(i);
        MeanEstimate mean = EstimateMean(row[i]->spread.All(), row[i]->missable, nearby);
        mean.rounding = estimates_[first + i].rounding[0];
        errors[first + i][c] = mean.StandardError();
      }
      first += size;
    }
  }
  return errors;
}

double RayTracingRendering::RelativeErrorAt(std::size_t point, const Spectrum& error,
                                            const std::vector<Spectrum>& means) const {
  double worst = 0;
  const Estimate& estimate = estimates_[point];
  for (int c = 0; c < kMaxChannels; ++c) {
    const double floor = kDarkest * means[probe_of_point_[point]][c];
    worst = std::max(worst, RelativeError(estimate.value[0][c], error[c], floor));
  }
  return worst;
}

// After each pass.
void RayTracingRendering::PlanPass(Clock::Time now) {
  const std::vector<Spectrum> means = MeansOverProbes();
  const std::vector<Spectrum> errors = IrradianceErrors();
  for (std::size_t point = 0; point < points_.size(); ++point) estimates_[point].error = errors[point];
  worst_error_ = 0;
  bool all_final = true;
  for (std::size_t point = 0; point < points_.size(); ++point) {
    const double error = RelativeErrorAt(point, errors[point], means);
    worst_error_ = std::max(*worst_error_, error);
    if (!settings_.target_error || decisions_[point] == Decision::kFinal) continue;
    const bool met = error <= *settings_.target_error;
    decisions_[point] = !met                                   ? Decision::kOpen
                        : decisions_[point] == Decision::kOpen ? Decision::kLast
                                                               : Decision::kFinal;
    all_final = all_final && decisions_[point] == Decision::kFinal;
  }
  constexpr std::uint32_t kMostRays = 1u << 30;
  if (settings_.target_error && all_final) {
    end_reason_ = EndReason::kTargetReached;
  } else if ((last_rays_ > 0 && pass_rays_ >= last_rays_) || pass_rays_ >= kMostRays) {
    end_reason_ = EndReason::kSamplesDone;
  } else if (settings_.time_limit && Seconds(now - *start_).count() >= *settings_.time_limit) {
    end_reason_ = EndReason::kTimeLimit;
  } else {
    // Where the end is known, few passes waste little on the way to it.
    const bool open_ended = settings_.target_error.has_value() || settings_.time_limit.has_value();
    const std::uint32_t next = pass_rays_ * (open_ended ? 2 : 4);
    BeginPass(last_rays_ > 0 && next * 2 > last_rays_ ? last_rays_ : next);
  }
}

template <class Self, class Stream>
void RayTracingRendering::State(Self& self, Stream& stream) {
  stream.Filled(self.estimates_);
  stream.Filled(self.decisions_);
  stream(self.pass_rays_, self.pass_, self.next_task_, self.unfinished_, self.rays_, self.work_done_, self.worst_error_,
         self.seconds_, self.end_reason_);
  for (const std::size_t point : self.pass_) stream.Require(point < self.estimates_.size());
  stream.Require(self.pass_rays_ > 0 && self.next_task_ <= self.pass_.size() * kReplicates &&
                 self.unfinished_.size() == self.next_task_ % kReplicates);
}

std::string RayTracingRendering::Checkpoint(std::size_t most_bytes) const {
  if (!tree_ || (!start_ && !resumed_)) return {};
  StateWriter writer(most_bytes);
  writer(start_ ? (now_ - *start_).count() : *resumed_);
  State(*this, writer);
  return writer.Take();
}

bool RayTracingRendering::Resume(std::string_view checkpoint) {
  if (!tree_) return false;
  StateReader reader(checkpoint);
  reader(resumed_.emplace());
  State(*this, reader);
  return reader.AtEnd();
}

RenderProgress RayTracingRendering::Progress() const {
  RenderProgress progress;
  progress.rays = rays_;
  for (const Estimate& estimate : estimates_) {
    progress.samples = std::max(progress.samples, static_cast<double>(kReplicates) * estimate.rays);
  }
  progress.relative_error = worst_error_;
  if (done()) {
    progress.fraction = 1;
    return progress;
  }
  if (last_rays_ > 0) {
    double all = 0;
    for (std::uint32_t rays = std::min(kFirstRays, last_rays_); rays < last_rays_ / 2 + 1; rays *= 4) all += rays;
    all = (all + last_rays_) * static_cast<double>(points_.size() * kReplicates);
    progress.fraction = std::min(work_done_ / all, 0.999);
  }
  if (settings_.time_limit) {
    progress.fraction = std::max(progress.fraction, std::min(seconds_ / *settings_.time_limit, 1.0));
  }
  if (progress.fraction > 0) progress.remaining_seconds = seconds_ * (1 - progress.fraction) / progress.fraction;
  return progress;
}

std::shared_ptr<const Field> RayTracingRendering::Snapshot() const {
  auto field = std::make_shared<Field>();
  field->rays = rays_;
  const WorldUnits units(scene_->frame());
  std::array<std::vector<Spectrum>, kQuantities> errors;
  for (std::size_t order = 0; order < kQuantities; ++order)
    if (Computes(static_cast<int>(order))) errors[order] = Errors(order);
  std::size_t point = 0;
  for (const Probe& probe : scene_->probes()) {
    ProbeField& values = field->probes.emplace_back();
    const std::array<std::vector<double>*, kQuantities> value = {&values.irradiance, &values.gradient, &values.hessian,
                                                                 &values.rotation_gradient};
    const std::array<std::vector<double>*, kQuantities> error = {
        &values.standard_error, &values.gradient_error, &values.hessian_error, &values.rotation_gradient_error};
    const std::array<double, kQuantities> unit = {units.irradiance, units.gradient, units.hessian, units.irradiance};
    for (std::size_t i = 0; i < probe.receivers.size(); ++i, ++point) {
      const Estimate& estimate = estimates_[point];
      values.samples.push_back(static_cast<double>(kReplicates) * estimate.rays);
      for (std::size_t order = 0; order < kQuantities; ++order) {
        if (!Computes(static_cast<int>(order))) continue;
        for (int c = 0; c < scene_->channels(); ++c) {
          value[order]->push_back(unit[order] * estimate.value[order][c]);
          // Rays meet the arcs that follow Béziers: where there is hardly any noise, that counts.
          const double followed = order == 0 ? scene_->bezier_distance() * estimate.value[0][c] : 0;
          error[order]->push_back(unit[order] * (errors[order][point][c] + followed));
        }
      }
    }
  }
  return field;
}

}  // namespace flatlight
