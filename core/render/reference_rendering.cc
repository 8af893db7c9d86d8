// SPDX-License-Identifier: Apache-2.0
#include "core/render/reference_rendering.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/plane/glossy/glossy_solver.h"
#include "core/plane/reference/reference_solver.h"
#include "core/render/exact_field.h"
#include "core/render/probe_points.h"
#include "core/render/skips.h"

namespace flatlight {
namespace {

using Seconds = std::chrono::duration<double>;

// Until a first round tells how far there is to go.
constexpr double kFirstRound = 0.05;

}  // namespace

ReferenceRendering::ReferenceRendering(std::shared_ptr<const Scene> scene,
                                       const std::shared_ptr<const RayCaster>& caster, const Plan& plan,
                                       std::shared_ptr<SolvedWorlds> worlds, std::string sharers)
    : scene_(std::move(scene)),
      worlds_(std::move(worlds)),
      sharers_(std::move(sharers)),
      derivatives_(static_cast<int>(plan.settings.derivatives.value_or(Derivatives::kNone))),
      target_error_(*plan.settings.target_error),
      time_limit_(plan.settings.time_limit),
      max_threads_(plan.MaxThreads()) {
  if (plan.Takes(skip::kEmission)) {
    end_reason_ = EndReason::kTargetReached;
    return;
  }
  ReferenceOptions options;
  options.derivatives = derivatives_;
  options.channels = plan.Takes(skip::kColour) ? 1 : kMaxChannels;
  options.max_bounces = plan.settings.max_bounces;
  options.target_error = target_error_;
  if (options.max_bounces != 0u && IsGlossy(*scene_)) {
    solver_ = std::make_unique<GlossySolver>(scene_, caster, options);
    return;
  }
  auto world = worlds_->Take(*scene_, static_cast<std::size_t>(options.channels), options.max_bounces, sharers_);
  solver_ = std::make_unique<ReferenceSolver>(scene_, caster, options, std::move(world));
}

void ReferenceRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                                 Clock::Duration budget) {
  if (done()) return;
  const int threads = std::max(std::min(max_threads_, executor.threads()), 1);
  const Clock::Time now = clock.Now();
  if (!start_) start_ = now;
  if (time_limit_) {
    const auto left = std::chrono::duration_cast<Clock::Duration>(
        std::max(Seconds(0), Seconds(*time_limit_) - Seconds(now - *start_)));
    budget = std::min(budget, left);
  }
  solver_->Advance(executor, threads, cancellation, clock, budget);
  if (solver_->state() == BoundedSolver::State::kReached) {
    end_reason_ = EndReason::kTargetReached;
    if (auto world = solver_->TakeWorld()) worlds_->Keep(std::move(world), sharers_);
  } else if (solver_->state() == BoundedSolver::State::kExhausted) {
    end_reason_ = EndReason::kAccuracyLimit;
  } else if (time_limit_ && Seconds(clock.Now() - *start_).count() >= *time_limit_) {
    end_reason_ = EndReason::kTimeLimit;
  }
}

RenderProgress ReferenceRendering::Progress() const {
  RenderProgress progress;
  progress.fraction = done() ? 1 : 0;
  if (!solver_ || solver_->rounds() == 0) return progress;
  progress.relative_error = solver_->relative_error();
  if (done()) return progress;
  const double way = std::log(solver_->first_relative_error() / target_error_);
  const double left = std::log(solver_->relative_error() / target_error_);
  progress.fraction = way > 0 && std::isfinite(way) && std::isfinite(left)
                          ? std::clamp(1 - left / way, kFirstRound, 0.99)
                          : kFirstRound;
  return progress;
}

std::shared_ptr<const Field> ReferenceRendering::Snapshot() const {
  auto field = std::make_shared<Field>();
  field->probes.resize(scene_->probes().size());
  const bool first = solver_ && solver_->rounds() == 0;
  if (first && !done()) return field;
  const std::vector<ExactValue> first_values = first ? solver_->FirstValues() : std::vector<ExactValue>();
  const auto channels = static_cast<std::size_t>(scene_->channels());
  const WorldUnits units(scene_->frame());
  double bound = 0;
  std::size_t i = 0;
  for (std::size_t p = 0; p < scene_->probes().size(); ++p) {
    ProbeField& values = field->probes[p];
    for (const std::size_t end = i + scene_->probes()[p].receivers.size(); i < end; ++i) {
      const ExactValue value = solver_ ? (first ? first_values : solver_->values())[i] : ExactValue{};
      for (std::size_t c = 0; c < channels; ++c) {
        values.irradiance.push_back(units.irradiance * value.irradiance.value[c]);
        values.irradiance_error.push_back(units.irradiance * value.irradiance_error.value[c]);
        bound = std::max(bound, values.irradiance_error.back());
      }
      AppendDerivatives(value, channels, derivatives_, units, values);
    }
  }
  field->error_bound = bound;
  return field;
}

}  // namespace flatlight
