// SPDX-License-Identifier: Apache-2.0
// What the passes of photon mapping tell so far: values, their errors and bias.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/render/photon_mapping_rendering.h"
#include "core/render/world_units.h"

namespace flatlight {
namespace {

constexpr double kDarkest = 0.01;  // Errors count in this share of the probe's mean at least (DESIGN 3).

}  // namespace

std::vector<WidthChooser> PhotonMappingRendering::Choosers() const {
  std::vector<WidthChooser> choosers(scene_->probes().size());
  if (!chooses_widths_ || photons_done_ == 0) return choosers;
  for (std::size_t point = 0; point < points_.size(); ++point) choosers[probe_of_point_[point]].Add(LadderAt(point));
  return choosers;
}

PhotonMappingRendering::Value PhotonMappingRendering::ValueAt(std::size_t number,
                                                              const std::vector<WidthChooser>& choosers) const {
  const Point& point = points_[number];
  Value value;
  value.value = {point.direct.irradiance, {}, point.direct.gradient, {}, {}};
  value.error = {point.direct.irradiance_error, {}, point.direct.gradient_error, {}, {}};
  if (photons_done_ == 0) return value;
  if (chooses_widths_) {
    AddDensity(number, choosers[probe_of_point_[number]], value);
    return value;
  }
  for (std::size_t q = 0; q < quantities_; ++q) {
    for (std::size_t c = 0; c < channels_; ++c) {
      const auto channel = static_cast<int>(c);
      double step = 0;
      if (q == kIrradiance) {
        step = point.step * light_->sources().flux()[channel] * kReplicates / static_cast<double>(photons_done_);
        if (gathers_) step = std::max(step, 2 * brightest_ * kReplicates / gathered_rays_);
      }
      const MeanEstimate mean = MeanOf(number, q, c, step);
      value.value[q][channel] += mean.mean;
      value.error[q][channel] += mean.StandardError();
    }
  }
  // A kernel that corrects for the ends of a curve may be negative.
  for (double& irradiance : value.value[kIrradiance].value) irradiance = std::max(irradiance, 0.0);
  return value;
}

MeanEstimate PhotonMappingRendering::MeanOf(std::size_t point, std::size_t quantity, std::size_t channel,
                                            double step) const {
  std::array<double, kReplicates> values;
  for (std::size_t r = 0; r < kReplicates; ++r)
    values[r] =
        sums_[Index(point, r, quantity) + channel] / static_cast<double>(PhotonTrace::PathsOf(r, photons_done_));
  return EstimateMean(values, step);
}

WidthLadder PhotonMappingRendering::LadderAt(std::size_t number) const {
  WidthLadder ladder;
  ladder.widest = points_[number].widest;
  const Spectrum& flux = light_->sources().flux();
  // By all channels together.
  for (std::size_t c = 0; c < channels_; ++c)
    ladder.photon += flux[static_cast<int>(c)] / static_cast<double>(photons_done_);
  ladder.densities.resize(quantities_);
  for (std::size_t j = 0; j < quantities_; ++j) {
    for (std::size_t r = 0; r < kReplicates; ++r) {
      for (std::size_t c = 0; c < channels_; ++c)
        ladder.densities[j][r] +=
            sums_[Index(number, r, j) + c] / static_cast<double>(PhotonTrace::PathsOf(r, photons_done_));
    }
  }
  return ladder;
}

void PhotonMappingRendering::AddDensity(std::size_t number, const WidthChooser& chooser, Value& value) const {
  const WidthLadder ladder = LadderAt(number);
  const Spectrum& flux = light_->sources().flux();
  const auto photons = static_cast<double>(photons_done_);
  const WidthChoice choice = chooser.Choose(ladder);
  double width = ladder.widest;
  for (std::size_t j = 0; j < choice.chosen; ++j) width /= WidthLadder::kRatio;
  double all = 0;
  for (std::size_t c = 0; c < channels_; ++c) {
    const auto channel = static_cast<int>(c);
    const double step = kReplicates * flux[channel] / (2 * width * photons);
    const MeanEstimate mean = MeanOf(number, choice.chosen, c, step);
    value.value[kIrradiance][channel] = std::max(mean.mean, 0.0);
    value.error[kIrradiance][channel] = mean.StandardError();
    all += std::abs(mean.mean);
  }
  // Shared out as the light is.
  for (int c = 0; c < static_cast<int>(channels_); ++c)
    value.value[kBias][c] =
        all > 0 ? choice.bias * value.value[kIrradiance][c] / all : choice.bias / static_cast<double>(channels_);
}

double PhotonMappingRendering::WorstError() const {
  std::vector<Spectrum> means(scene_->probes().size());
  std::vector<Value> values;
  const std::vector<WidthChooser> choosers = Choosers();
  for (std::size_t point = 0; point < points_.size(); ++point) {
    values.push_back(ValueAt(point, choosers));
    const std::size_t probe = probe_of_point_[point];
    const double share = 1 / static_cast<double>(scene_->probes()[probe].receivers.size());
    means[probe] = means[probe] + share * values.back().value[kIrradiance];
  }
  double worst = 0;
  for (std::size_t point = 0; point < points_.size(); ++point) {
    for (int c = 0; c < static_cast<int>(channels_); ++c) {
      const double error = values[point].error[kIrradiance][c] + std::abs(values[point].value[kBias][c]);
      worst = std::max(worst, RelativeError(values[point].value[kIrradiance][c], error,
                                            kDarkest * means[probe_of_point_[point]][c]));
    }
  }
  return worst;
}

RenderProgress PhotonMappingRendering::Progress() const {
  RenderProgress progress;
  progress.rays = rays_ + chain_rays_;
  progress.samples = gathered_rays_;
  progress.relative_error = worst_error_;
  if (done()) {
    progress.fraction = 1;
    return progress;
  }
  if (settings_.photons && tracer_) {
    const double within = 0.5 * (pass_.trace.fraction() + (pass_.trace.done() ? pass_.look.fraction() : 0));
    const auto pass = static_cast<double>(pass_.trace.end() - pass_.trace.first());
    progress.fraction =
        std::min(0.999, (static_cast<double>(photons_done_) + within * pass) / static_cast<double>(*settings_.photons));
  }
  if (settings_.time_limit)
    progress.fraction = std::max(progress.fraction, std::min(seconds_ / *settings_.time_limit, 1.0));
  if (progress.fraction > 0) progress.remaining_seconds = seconds_ * (1 - progress.fraction) / progress.fraction;
  return progress;
}

std::shared_ptr<const Field> PhotonMappingRendering::Snapshot() const {
  auto field = std::make_shared<Field>();
  field->rays = rays_ + chain_rays_;
  field->photons = static_cast<double>(photons_done_);
  const WorldUnits units(scene_->frame());
  // Nothing is known yet.
  const bool known = done() || photons_done_ > 0;
  std::size_t number = 0;
  const std::vector<WidthChooser> choosers = Choosers();
  for (const Probe& probe : scene_->probes()) {
    ProbeField& values = field->probes.emplace_back();
    for (std::size_t i = 0; known && i < probe.receivers.size(); ++i, ++number) {
      const Value value = ValueAt(number, choosers);
      if (gathers_) values.samples.push_back(gathered_rays_);
      for (int c = 0; c < static_cast<int>(channels_); ++c) {
        const double irradiance = value.value[kIrradiance][c];
        // Rays meet the arcs that follow Béziers: where there is hardly any noise, that counts.
        const double followed = scene_->bezier_distance() * irradiance;
        values.irradiance.push_back(units.irradiance * irradiance);
        values.standard_error.push_back(units.irradiance * (value.error[kIrradiance][c] + followed));
        values.estimated_bias.push_back(units.irradiance * std::abs(value.value[kBias][c]));
        if (derivatives_ > 0) {
          values.gradient.push_back(units.gradient * value.value[kGradient][c]);
          const double bias = std::abs(value.value[kGradientBias][c]) + std::abs(value.value[kGatherBias][c]);
          values.gradient_error.push_back(units.gradient * (value.error[kGradient][c] + bias));
        }
        if (derivatives_ > 1) {
          values.hessian.push_back(units.hessian * points_[number].direct.hessian[c]);
          values.hessian_error.push_back(units.hessian * points_[number].direct.hessian_error[c]);
        }
      }
    }
  }
  return field;
}

}  // namespace flatlight
