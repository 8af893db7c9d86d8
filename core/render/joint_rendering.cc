// SPDX-License-Identifier: Apache-2.0
#include "core/render/joint_rendering.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/render/state_stream.h"

namespace flatlight {

void JointRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                             Clock::Duration budget) {
  const Clock::Duration share = points_->done() || pictures_->done() ? budget : budget / 2;
  if (!points_->done()) points_->Advance(executor, cancellation, clock, share);
  if (!pictures_->done() && !cancellation.cancelled()) pictures_->Advance(executor, cancellation, clock, share);
}

EndReason JointRendering::end_reason() const {
  const EndReason points = points_->end_reason(), pictures = pictures_->end_reason();
  return points == EndReason::kTimeLimit ? points : pictures;
}

RenderProgress JointRendering::Progress() const {
  const RenderProgress points = points_->Progress(), pictures = pictures_->Progress();
  RenderProgress progress;
  progress.fraction = 0.5 * (points.fraction + pictures.fraction);
  progress.samples = std::max(points.samples, pictures.samples);
  progress.rays = points.rays + pictures.rays;
  const double left = points.remaining_seconds.value_or(0) + pictures.remaining_seconds.value_or(0);
  if (points.remaining_seconds || pictures.remaining_seconds) progress.remaining_seconds = left;
  if (points.relative_error || pictures.relative_error) {
    progress.relative_error = std::max(points.relative_error.value_or(0), pictures.relative_error.value_or(0));
  }
  return progress;
}

std::shared_ptr<const Field> JointRendering::Snapshot() const {
  auto field = std::make_shared<Field>(*points_->Snapshot());
  const std::shared_ptr<const Field> pictures = pictures_->Snapshot();
  field->rays += pictures->rays;
  if (field->error_bound.has_value()) {
    field->error_bound = pictures->error_bound.has_value()
                             ? std::optional(std::max(*field->error_bound, *pictures->error_bound))
                             : std::nullopt;
  }
  for (std::size_t probe = 0; probe < field->probes.size(); ++probe) {
    if (!pictures->probes[probe].irradiance.empty()) field->probes[probe] = pictures->probes[probe];
  }
  return field;
}

std::string JointRendering::Checkpoint(std::size_t most_bytes) const {
  const std::string points = points_->Checkpoint(most_bytes);
  const std::string pictures = pictures_->Checkpoint(most_bytes - points.size());
  if (points.empty() && pictures.empty()) return {};
  StateWriter writer(most_bytes);
  writer(points, pictures);
  return writer.Take();
}

bool JointRendering::Resume(std::string_view checkpoint) {
  StateReader reader(checkpoint);
  std::string points, pictures;
  reader(points, pictures);
  return reader.AtEnd() && (points.empty() || points_->Resume(points)) &&
         (pictures.empty() || pictures_->Resume(pictures));
}

}  // namespace flatlight
