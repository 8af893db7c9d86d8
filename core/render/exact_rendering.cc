// SPDX-License-Identifier: Apache-2.0
#include "core/render/exact_rendering.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/render/exact_field.h"
#include "core/render/probe_points.h"
#include "core/render/skips.h"

namespace flatlight {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kShardSeconds = 1e-3;
constexpr double kMostPointsPerShard = 1024;
constexpr double kShardsPerThread = 16;

int OrderOf(const Plan& plan) { return static_cast<int>(plan.settings.derivatives.value_or(Derivatives::kNone)); }

ExactOptions OptionsOf(const Plan& plan) {
  ExactOptions options;
  options.derivatives = OrderOf(plan);
  options.occlusion = !plan.Takes(skip::kVisibility);
  options.channels = plan.Takes(skip::kColour) ? 1 : kMaxChannels;
  return options;
}

}  // namespace

ExactRendering::ExactRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                               std::shared_ptr<const Triangulation> triangulation, const Plan& plan)
    : scene_(std::move(scene)),
      caster_(std::move(caster)),
      triangulation_(std::move(triangulation)),
      options_(OptionsOf(plan)),
      derivatives_(OrderOf(plan)),
      dark_(plan.Takes(skip::kEmission)),
      max_threads_(plan.MaxThreads()),
      points_(PointsOfProbes(*scene_)),
      values_(points_.size()) {
  if (!dark_ && scene_->traits().lights > 0) lights_.emplace(*caster_, options_);
  if (dark_) done_points_ = points_.size();
}

void ExactRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                             Clock::Duration budget) {
  const int threads = std::max(std::min(max_threads_, executor.threads()), 1);
  const Clock::Time start = clock.Now();
  const double elapsed_before = elapsed_seconds_;
  Clock::Time now = start;
  while (!done() && !cancellation.cancelled()) {
    const double rounds = std::clamp(Seconds(budget - (now - start)).count() / kShardSeconds, 1.0, kShardsPerThread);
    const auto shard = static_cast<std::size_t>(points_per_shard_);
    const std::size_t left = points_.size() - done_points_;
    const std::size_t shards = std::min(
        (left + shard - 1) / shard, static_cast<std::size_t>(std::floor(rounds)) * static_cast<std::size_t>(threads));
    std::vector<char> complete(shards, 0);
    executor.ParallelFor(shards, threads, [&](std::size_t i) {
      const std::size_t first = done_points_ + i * shard;
      complete[i] = Work(first, std::min(first + shard, points_.size()), cancellation) ? 1 : 0;
    });
    const auto merged = static_cast<std::size_t>(std::find(complete.begin(), complete.end(), 0) - complete.begin());
    done_points_ = std::min(done_points_ + merged * shard, points_.size());
    const Clock::Time after = clock.Now();
    const double used_threads = static_cast<double>(std::min(static_cast<std::size_t>(threads), shards));
    const double worked = static_cast<double>(std::min(shards * shard, left));
    const double seconds_per_point = Seconds(after - now).count() * used_threads / worked;
    const double best = seconds_per_point > 0 ? kShardSeconds / seconds_per_point : kMostPointsPerShard;
    points_per_shard_ = std::clamp(std::min(best, 4 * points_per_shard_), 1.0, kMostPointsPerShard);
    now = after;
    elapsed_seconds_ = elapsed_before + Seconds(now - start).count();
    if (now - start >= budget) return;
  }
}

bool ExactRendering::Work(std::size_t first, std::size_t last, const Cancellation& cancellation) {
  std::unique_ptr<ExactSolver> solver = TakeSolver();
  std::size_t i = first;
  for (; i < last && !cancellation.cancelled(); ++i) {
    values_[i] = solver->Evaluate(*points_[i]);
    if (lights_) lights_->Add(*points_[i], values_[i]);
  }
  ReturnSolver(std::move(solver));
  return i == last;
}

std::unique_ptr<ExactSolver> ExactRendering::TakeSolver() {
  {
    const std::lock_guard<std::mutex> lock(solvers_mutex_);
    if (!idle_solvers_.empty()) {
      std::unique_ptr<ExactSolver> solver = std::move(idle_solvers_.back());
      idle_solvers_.pop_back();
      return solver;
    }
  }
  return std::make_unique<ExactSolver>(*scene_, caster_->bvh(), options_, triangulation_.get());
}

void ExactRendering::ReturnSolver(std::unique_ptr<ExactSolver> solver) {
  const std::lock_guard<std::mutex> lock(solvers_mutex_);
  idle_solvers_.push_back(std::move(solver));
}

RenderProgress ExactRendering::Progress() const {
  RenderProgress progress;
  const auto all = static_cast<double>(points_.size());
  progress.fraction = done() ? 1 : static_cast<double>(done_points_) / all;
  if (progress.fraction > 0) {
    progress.remaining_seconds = elapsed_seconds_ * (1 - progress.fraction) / progress.fraction;
  }
  return progress;
}

std::shared_ptr<const Field> ExactRendering::Snapshot() const {
  auto field = std::make_shared<Field>();
  const auto channels = static_cast<std::size_t>(scene_->channels());
  const WorldUnits units(scene_->frame());
  double bound = 0;
  std::size_t point = 0;
  for (const Probe& probe : scene_->probes()) {
    ProbeField& values = field->probes.emplace_back();
    const std::size_t end = point + probe.receivers.size();
    if (end <= done_points_) {
      for (std::size_t i = point; i < end; ++i) {
        const ExactValue& value = values_[i];
        for (std::size_t c = 0; c < channels; ++c) {
          values.irradiance.push_back(units.irradiance * value.irradiance.value[c]);
          bound = std::max(bound, units.irradiance * value.irradiance_error.value[c]);
        }
        AppendDerivatives(value, channels, derivatives_, units, values);
      }
    }
    point = end;
  }
  if (done()) field->error_bound = bound;
  return field;
}

}  // namespace flatlight
