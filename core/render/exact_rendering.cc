// SPDX-License-Identifier: Apache-2.0
#include "core/render/exact_rendering.h"

#include <algorithm>
#include <utility>

#include "core/render/exact_field.h"
#include "core/render/probe_points.h"
#include "core/render/skips.h"
#include "core/render/state_stream.h"

namespace flatlight {
namespace {

int OrderOf(const Plan& plan) { return static_cast<int>(plan.settings.derivatives.value_or(Derivatives::kNone)); }

}  // namespace

ExactOptions ExactOptionsOf(const Plan& plan) {
  ExactOptions options;
  options.derivatives = OrderOf(plan);
  options.occlusion = !plan.Takes(skip::kVisibility);
  options.channels = plan.Takes(skip::kColour) ? 1 : kMaxChannels;
  return options;
}

ExactRendering::ExactRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                               std::shared_ptr<const Triangulation> triangulation, const Plan& plan)
    : scene_(std::move(scene)),
      caster_(std::move(caster)),
      triangulation_(std::move(triangulation)),
      options_(ExactOptionsOf(plan)),
      derivatives_(OrderOf(plan)),
      dark_(plan.Takes(skip::kEmission)),
      max_threads_(plan.MaxThreads()),
      points_(PointsOfProbes(*scene_)),
      values_(points_.size()),
      work_(points_.size()) {
  if (!dark_ && scene_->traits().lights > 0) lights_.emplace(*caster_, options_);
  if (dark_) work_.Finish();
}

void ExactRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                             Clock::Duration budget) {
  work_.Advance(executor, max_threads_, cancellation, clock, budget,
                [&](std::size_t first, std::size_t last) { return Work(first, last, cancellation); });
}

bool ExactRendering::Work(std::size_t first, std::size_t last, const Cancellation& cancellation) {
  std::unique_ptr<ExactSolver> solver = solvers_.Take(
      [&] { return std::make_unique<ExactSolver>(*scene_, caster_->bvh(), options_, triangulation_.get()); });
  std::size_t i = first;
  for (; i < last && !cancellation.cancelled(); ++i) {
    solver->Evaluate(*points_[i], values_[i]);
    const double angle = 2 * points_[i]->half_angle;
    if (angle > 0) {
      values_[i].irradiance = (1 / angle) * values_[i].irradiance;
      values_[i].irradiance_error = (1 / angle) * values_[i].irradiance_error;
    } else if (lights_) {
      lights_->Add(*points_[i], values_[i]);
    }
  }
  solvers_.Return(std::move(solver));
  return i == last;
}

std::string ExactRendering::Checkpoint(std::size_t most_bytes) const {
  StateWriter writer(most_bytes);
  writer(work_);
  for (std::size_t i = 0; i < work_.done_items() && writer.ok(); ++i) writer(values_[i]);
  return writer.Take();
}

bool ExactRendering::Resume(std::string_view checkpoint) {
  StateReader reader(checkpoint);
  reader(work_);
  for (std::size_t i = 0; reader.ok() && i < work_.done_items(); ++i) reader(values_[i]);
  return reader.AtEnd();
}

RenderProgress ExactRendering::Progress() const {
  RenderProgress progress;
  progress.fraction = work_.fraction();
  if (progress.fraction > 0) {
    progress.remaining_seconds = work_.seconds() * (1 - progress.fraction) / progress.fraction;
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
    if (end <= work_.done_items()) {
      for (std::size_t i = point; i < end; ++i) {
        const ExactValue& value = values_[i];
        for (std::size_t c = 0; c < channels; ++c) {
          values.irradiance.push_back(units.irradiance * value.irradiance.value[c]);
          bound = std::max(bound, units.irradiance * value.irradiance_error.value[c]);
        }
        if (probe.camera) continue;
        AppendDerivatives(value, channels, derivatives_, units, values);
        for (std::size_t c = 0; c < channels && derivatives_ > 0; ++c) {
          values.rotation_gradient.push_back(units.irradiance * value.rotation.value[c]);
          values.rotation_gradient_error.push_back(units.irradiance * value.rotation_error.value[c]);
        }
      }
    }
    point = end;
  }
  if (done()) field->error_bound = bound;
  return field;
}

}  // namespace flatlight
