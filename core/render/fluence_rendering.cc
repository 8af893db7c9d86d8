// SPDX-License-Identifier: Apache-2.0
#include "core/render/fluence_rendering.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/render/probe_points.h"
#include "core/render/skips.h"
#include "core/render/state_stream.h"

namespace flatlight {
namespace {

using Seconds = std::chrono::duration<double>;

// Of the budget, or of what a watcher waits for anyway: between two looks at the clock.
constexpr double kRoundSeconds = 0.02;
constexpr std::uint32_t kMostRoundPaths = 1u << 16;
// Between two looks at whether the job was cancelled.
constexpr std::uint32_t kPathsBetweenLooks = 64;
// Then sums of single precision, 2^24 times what is added, begin to ignore it: a few bounces each, there is room.
constexpr double kMostPassesAPixel = 1 << 21;

Box Around(const std::vector<PixelGrid>& grids) {
  Box box;
  for (const PixelGrid& grid : grids) box.Add(grid.low), box.Add(grid.high);
  return box;
}

std::vector<PixelGrid> PicturesOf(const Scene& scene) {
  std::vector<PixelGrid> grids;
  for (const Probe& probe : scene.probes())
    if (probe.picture) grids.push_back(*probe.picture);
  return grids;
}

}  // namespace

FluenceRendering::FluenceRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                                   const Plan& plan)
    : scene_(std::move(scene)),
      seed_(plan.settings.seed.value_or(0)),
      channels_(plan.Takes(skip::kColour) || plan.Takes(skip::kEmission) ? 1 : kMaxChannels),
      max_threads_(plan.MaxThreads()),
      target_error_(plan.settings.target_error),
      time_limit_(plan.settings.time_limit),
      grids_(PicturesOf(*scene_)) {
  double most = std::numeric_limits<std::uint32_t>::max();
  for (const PixelGrid& grid : grids_) {
    pixels_ = std::max(pixels_, grid.pixels());
    // A line meets as many pixels of a picture as lie in a row or a column of it.
    most = std::min(most, kMostPassesAPixel * std::max(grid.width, grid.height));
  }
  if (plan.picture_samples.has_value()) {
    most = std::min(most, std::ceil(static_cast<double>(pixels_) * *plan.picture_samples / kReplicates));
  }
  most_paths_ = static_cast<std::uint64_t>(most);
  if (!plan.Takes(skip::kEmission)) {
    std::optional<std::uint32_t> max_bounces = plan.settings.max_bounces;
    if (plan.Takes(skip::kBounces)) max_bounces = 0;
    tracer_.emplace(std::move(caster), Around(grids_), max_bounces);
    if (tracer_->sources().empty()) tracer_.reset();
  }
  if (!tracer_) end_reason_ = EndReason::kSamplesDone;
  for (Replicate& replicate : replicates_)
    for (const PixelGrid& grid : grids_) replicate.images.emplace_back(grid, channels_);
}

void FluenceRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                               Clock::Duration budget) {
  if (done()) return;
  const Clock::Time begin = clock.Now();
  if (!start_) start_ = begin - Clock::Duration(resumed_.value_or(0));
  const double budget_seconds = Seconds(budget).count();
  const double seconds_before = seconds_;
  while (!done() && !cancellation.cancelled()) {
    const std::uint64_t paths = replicates_[0].paths;
    double wanted = seconds_per_path_ > 0 ? std::min(kRoundSeconds, budget_seconds) / seconds_per_path_ : 1;
    // Measured over few paths times mean little.
    wanted = std::min(wanted, 4.0 * static_cast<double>(paths) + 16);
    // Where tests are due must not depend on how long rounds take.
    const std::uint64_t end = target_error_ ? std::min(most_paths_, next_test_) : most_paths_;
    const std::uint64_t left = std::min<std::uint64_t>(end - paths, kMostRoundPaths);
    const auto round = std::min(static_cast<std::uint64_t>(std::max(wanted, 1.0)), left);
    const Clock::Time before = clock.Now();
    if (!AddPaths(static_cast<std::uint32_t>(round), executor, cancellation)) return;
    const Clock::Time after = clock.Now();
    seconds_per_path_ = Seconds(after - before).count() / static_cast<double>(round);
    seconds_ = seconds_before + Seconds(after - begin).count();
    DecideEnd(after);
    if (after - begin >= budget) return;
  }
}

bool FluenceRendering::AddPaths(std::uint32_t paths, Executor& executor, const Cancellation& cancellation) {
  const std::uint64_t goal = replicates_[0].paths + paths;
  executor.ParallelFor(kReplicates, max_threads_, [&](std::size_t r) {
    Replicate& replicate = replicates_[r];
    const SampleStream stream(seed_, ~std::uint64_t{0}, r);  // No probe has a point of this number.
    while (replicate.paths < goal) {
      if (replicate.paths % kPathsBetweenLooks == 0 && cancellation.cancelled()) return;
      replicate.rays += tracer_->AddPath(stream, static_cast<std::uint32_t>(replicate.paths++), replicate.images);
    }
  });
  return std::all_of(replicates_.begin(), replicates_.end(), [&](const Replicate& r) { return r.paths == goal; });
}

void FluenceRendering::DecideEnd(Clock::Time now) {
  now_ = now;
  const std::uint64_t paths = replicates_[0].paths;
  // One decision for all pixels hardly biases any (THEORY 18 B12.3), and seldom ones are cheap.
  if (target_error_ && paths >= next_test_) {
    next_test_ = 2 * paths;
    worst_error_ = WorstError();
    if (*worst_error_ <= *target_error_) end_reason_ = EndReason::kTargetReached;
  }
  if (paths >= most_paths_) end_reason_ = EndReason::kSamplesDone;
  if (time_limit_ && Seconds(now - *start_).count() >= *time_limit_) end_reason_ = EndReason::kTimeLimit;
}

std::string FluenceRendering::Checkpoint(std::size_t most_bytes) const {
  if (!start_ && !resumed_) return {};
  StateWriter writer(most_bytes);
  writer(start_ ? (now_ - *start_).count() : *resumed_);
  State(*this, writer);
  return writer.Take();
}

bool FluenceRendering::Resume(std::string_view checkpoint) {
  if (done()) return false;
  StateReader reader(checkpoint);
  reader(resumed_.emplace());
  State(*this, reader);
  for (const Replicate& replicate : replicates_) reader.Require(replicate.paths == replicates_[0].paths);
  reader.Require(end_reason_.has_value() || replicates_[0].paths < most_paths_);
  return reader.AtEnd();
}

RenderProgress FluenceRendering::Progress() const {
  RenderProgress progress;
  const auto paths = static_cast<double>(replicates_[0].paths);
  for (const Replicate& replicate : replicates_) progress.rays += replicate.rays;
  progress.samples = kReplicates * paths / static_cast<double>(pixels_);
  progress.relative_error = worst_error_;
  progress.fraction = done() ? 1 : paths / static_cast<double>(most_paths_);
  if (!done() && time_limit_) progress.fraction = std::max(progress.fraction, std::min(seconds_ / *time_limit_, 1.0));
  if (progress.fraction > 0) progress.remaining_seconds = seconds_ * (1 - progress.fraction) / progress.fraction;
  return progress;
}

ProbeField FluenceRendering::FieldOf(std::size_t picture, const PixelGrid& grid) const {
  const auto computed = static_cast<std::size_t>(channels_);
  const auto channels = static_cast<std::size_t>(scene_->channels());
  ProbeField field;
  field.irradiance.assign(grid.pixels() * channels, 0);
  field.standard_error.assign(grid.pixels() * channels, 0);
  const auto paths = static_cast<double>(replicates_[0].paths);
  if (!tracer_ || paths == 0) return field;
  const double scale = scene_->frame().radiance_scale / paths;
  // What one path would give a pixel that it crosses.
  const double width = (grid.high.x - grid.low.x) / grid.width, height = (grid.high.y - grid.low.y) / grid.height;
  const double step = std::sqrt(width * width + height * height) / (width * height);
  const Spectrum one = step * tracer_->sources().flux();
  std::array<double, kReplicates> values;
  for (std::size_t pixel = 0; pixel < grid.pixels(); ++pixel) {
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t from = ComputedChannel(c, computed);
      for (std::size_t r = 0; r < kReplicates; ++r) {
        values[r] = static_cast<double>(replicates_[r].images[picture].sums()[pixel * computed + from]);
      }
      const MeanEstimate estimate = EstimateMean(values, one.value[from]);
      field.irradiance[pixel * channels + c] = scale * estimate.mean;
      field.standard_error[pixel * channels + c] = scale * estimate.StandardError();
    }
  }
  return field;
}

double FluenceRendering::WorstError() const {
  constexpr double kDarkest = 0.01;  // In means of the picture (DESIGN 3).
  const auto channels = static_cast<std::size_t>(scene_->channels());
  double worst = 0;
  for (std::size_t picture = 0; picture < grids_.size(); ++picture) {
    const ProbeField field = FieldOf(picture, grids_[picture]);
    Spectrum mean;
    for (std::size_t i = 0; i < field.irradiance.size(); ++i) {
      mean.value[i % channels] += field.irradiance[i] / static_cast<double>(grids_[picture].pixels());
    }
    for (std::size_t i = 0; i < field.irradiance.size(); ++i) {
      worst = std::max(
          worst, RelativeError(field.irradiance[i], field.standard_error[i], kDarkest * mean.value[i % channels]));
    }
  }
  return worst;
}

std::shared_ptr<const Field> FluenceRendering::Snapshot() const {
  auto field = std::make_shared<Field>();
  for (const Replicate& replicate : replicates_) field->rays += replicate.rays;
  std::size_t picture = 0;
  for (const Probe& probe : scene_->probes()) {
    field->probes.push_back(probe.picture ? FieldOf(picture++, *probe.picture) : ProbeField{});
  }
  return field;
}

}  // namespace flatlight
