// SPDX-License-Identifier: Apache-2.0
#include "core/render/exact_picture_rendering.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/render/exact_rendering.h"
#include "core/render/probe_points.h"
#include "core/render/skips.h"
#include "core/render/world_units.h"

namespace flatlight {
namespace {

// Of a pixel's fluence: below what a picture shows.
constexpr double kTolerance = 1e-3;
constexpr double kDarkest = 0.01;  // In means of the picture (DESIGN 3).

}  // namespace

ExactPictureRendering::ExactPictureRendering(std::shared_ptr<const Scene> scene,
                                             std::shared_ptr<const RayCaster> caster,
                                             std::shared_ptr<const Triangulation> triangulation, const Plan& plan)
    : scene_(std::move(scene)),
      caster_(std::move(caster)),
      triangulation_(std::move(triangulation)),
      options_(ExactOptionsOf(plan)),
      max_threads_(plan.MaxThreads()),
      at_middles_(scene_->traits().pixels),
      values_(scene_->traits().pixels),
      middles_(scene_->traits().pixels),
      means_(scene_->traits().pixels) {
  options_.derivatives = 0;
  std::size_t first = 0;
  for (const Probe& probe : scene_->probes()) {
    if (!probe.picture) continue;
    const PixelGrid& grid = *probe.picture;
    pictures_.push_back(
        {grid, {(grid.high.x - grid.low.x) / grid.width, (grid.high.y - grid.low.y) / grid.height}, first, {}});
    first += grid.pixels();
  }
  if (plan.Takes(skip::kEmission)) middles_.Finish(), means_.Finish();
}

void ExactPictureRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                                    Clock::Duration budget) {
  const auto advance = [&](OrderedWork& work, Clock::Duration time, auto find) {
    work.Advance(executor, max_threads_, cancellation, clock, time, [&](std::size_t first, std::size_t last) {
      auto solver =
          solvers_.Take([&] { return std::make_unique<FluenceSolver>(*caster_, options_, triangulation_.get()); });
      std::size_t pixel = first;
      for (; pixel < last && !cancellation.cancelled(); ++pixel) find(*solver, pixel);
      solvers_.Return(std::move(solver));
      return pixel == last;
    });
  };
  const Clock::Time start = clock.Now();
  if (!middles_.done()) {
    advance(middles_, budget, [this](FluenceSolver& solver, std::size_t pixel) { FindMiddle(solver, pixel); });
    if (!middles_.done()) return;
    SetLeast();
  }
  const Clock::Duration left = budget - (clock.Now() - start);
  if (left <= Clock::Duration::zero()) return;
  advance(means_, left, [this](FluenceSolver& solver, std::size_t pixel) { FindMean(solver, pixel); });
}

const ExactPictureRendering::Picture& ExactPictureRendering::PictureOf(std::size_t pixel) const {
  std::size_t i = pictures_.size() - 1;
  while (pictures_[i].first > pixel) --i;
  return pictures_[i];
}

Point2 ExactPictureRendering::Middle(const Picture& picture, std::size_t pixel) const {
  const std::size_t index = pixel - picture.first;
  const std::size_t column = index % picture.grid.width, row = index / picture.grid.width;
  const double x = static_cast<double>(column) + 0.5, y = static_cast<double>(row) + 0.5;
  return picture.grid.low + Vector2{x * picture.box.x, y * picture.box.y};
}

void ExactPictureRendering::FindMiddle(FluenceSolver& solver, std::size_t pixel) {
  const Picture& picture = PictureOf(pixel);
  at_middles_[pixel] = solver.At(Middle(picture, pixel), picture.box);
}

void ExactPictureRendering::SetLeast() {
  for (Picture& picture : pictures_) {
    Spectrum sum;
    for (std::size_t i = 0; i < picture.grid.pixels(); ++i) sum = sum + at_middles_[picture.first + i];
    picture.least = (kDarkest / static_cast<double>(picture.grid.pixels())) * sum;
  }
  for (std::size_t pixel = 0; pixel < values_.size(); ++pixel) {
    values_[pixel] = {at_middles_[pixel], Bent(PictureOf(pixel), pixel)};
  }
}

Spectrum ExactPictureRendering::Bent(const Picture& picture, std::size_t pixel) const {
  const std::size_t width = picture.grid.width, index = pixel - picture.first;
  const std::size_t x = index % width, y = index / width;
  Spectrum bent = at_middles_[pixel];  // Where nothing is known of one neighbour.
  if (x == 0 || y == 0 || x + 1 == width || y + 1 == picture.grid.height) return bent;
  bent = {};
  for (const std::size_t step : {std::size_t{1}, width - 1, width, width + 1}) {
    for (int c = 0; c < kMaxChannels; ++c) {
      const double second = at_middles_[pixel - step][c] + at_middles_[pixel + step][c] - 2 * at_middles_[pixel][c];
      bent[c] = std::max(bent[c], 0.5 * std::abs(second));
    }
  }
  return bent;
}

void ExactPictureRendering::FindMean(FluenceSolver& solver, std::size_t pixel) {
  const Picture& picture = PictureOf(pixel);
  const std::size_t index = pixel - picture.first, width = picture.grid.width;
  const bool inside =
      index % width > 0 && index % width + 1 < width && index >= width && index + width < picture.grid.pixels();
  Spectrum tolerance;
  bool good = inside;
  for (int c = 0; c < options_.channels; ++c) {
    tolerance[c] = kTolerance * std::max(at_middles_[pixel][c], picture.least[c]);
    good = good && values_[pixel].error[c] <= tolerance[c];
  }
  if (!good) values_[pixel] = solver.Mean(Middle(picture, pixel), picture.box, tolerance);
}

RenderProgress ExactPictureRendering::Progress() const {
  RenderProgress progress;
  progress.fraction = 0.5 * (middles_.fraction() + means_.fraction());
  if (progress.fraction > 0) {
    const double seconds = middles_.seconds() + means_.seconds();
    progress.remaining_seconds = seconds * (1 - progress.fraction) / progress.fraction;
  }
  return progress;
}

std::shared_ptr<const Field> ExactPictureRendering::Snapshot() const {
  auto field = std::make_shared<Field>();
  const auto channels = static_cast<std::size_t>(scene_->channels());
  const auto computed = static_cast<std::size_t>(options_.channels);
  const double scale = WorldUnits(scene_->frame()).irradiance;
  double largest = 0;
  std::size_t pixel = 0;
  for (const Probe& probe : scene_->probes()) {
    ProbeField& values = field->probes.emplace_back();
    if (!probe.picture || !middles_.done()) continue;
    values.irradiance.reserve(probe.points() * channels);
    values.irradiance_error.reserve(probe.points() * channels);
    for (const std::size_t end = pixel + probe.points(); pixel < end; ++pixel) {
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t from = ComputedChannel(c, computed);
        values.irradiance.push_back(scale * values_[pixel].value.value[from]);
        values.irradiance_error.push_back(scale * values_[pixel].error.value[from]);
        largest = std::max(largest, values.irradiance_error.back());
      }
    }
  }
  if (done()) field->error_bound = largest;
  return field;
}

}  // namespace flatlight
