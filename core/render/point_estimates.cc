// SPDX-License-Identifier: Apache-2.0
#include "core/render/point_estimates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace flatlight {
namespace {

// What sharing sequences gains takes more of them to tell, and differs less.
constexpr std::size_t kRatioNeighbours = 32;
constexpr PointBlocks::Halves kBoth{0, 2};

}  // namespace

PointEstimates::PointEstimates(const PointBlocks& blocks, std::size_t first, std::size_t last, bool alone)
    : blocks_(blocks), first_(first), last_(last), alone_(alone), known_((last - first) * blocks.channels()) {
  for (std::size_t point = first_; point < last_; ++point) {
    if (blocks_.blocks(point) == 0) continue;
    for (std::size_t c = 0; c < blocks_.channels(); ++c) {
      Known& known = At(point, c);
      known.missable = MissableBy(kBoth, point, c);
      known.nearby = NearbyOf(point, c);
      const std::array<double, kReplicates> values = blocks_.Replicates(point, c);
      const MeanEstimate estimate = blocks_.Estimate(point, c, kBoth, known.missable, known.nearby);
      const double rounding = kReplicateRounding * estimate.mean;
      if (estimate.variance > rounding * rounding)
        known.own_ratio.Add(HalvesRatios::SquaredError(values), estimate.variance);
    }
  }
  for (std::size_t point = first_; point < last_; ++point)
    for (std::size_t c = 0; c < blocks_.channels(); ++c) At(point, c).ratio = RatioOf(point, c);
  if (alone_) return;
  for (std::size_t c = 0; c < blocks_.channels(); ++c) {
    std::vector<std::optional<RowPoint>> row(last_ - first_);
    for (std::size_t point = first_; point < last_; ++point) {
      if (blocks_.blocks(point) == 0) continue;
      const Known& known = At(point, c);
      row[point - first_] = {HalvesSpreadOf(blocks_.Replicates(point, c)), blocks_.OfMeans(point, known.missable),
                             blocks_.doubt(point, c).step / static_cast<double>(blocks_.blocks(point)),
                             known.ratio.ratio};
    }
    misses_.emplace_back(std::move(row));
  }
}

MeanEstimate PointEstimates::Of(std::size_t point, std::size_t channel) const {
  const Known& known = At(point, channel);
  NearbyVariance nearby = known.nearby;
  nearby.missed = misses_[channel].At(point - first_);
  return known.ratio.Of(blocks_.Estimate(point, channel, kBoth, known.missable, nearby));
}

MeanEstimate PointEstimates::OfHalf(std::size_t point, std::size_t half, std::size_t channel) const {
  const PointBlocks::Halves halves{half, half + 1};
  return At(point, channel)
      .ratio.Of(blocks_.Estimate(point, channel, halves, MissableBy(halves, point, channel), NearbyVariance()));
}

std::pair<std::size_t, std::size_t> PointEstimates::Neighbours(std::size_t point, std::size_t reach) const {
  const auto [begin, end] = NeighboursInRow(point - first_, last_ - first_, reach);
  return {first_ + begin, first_ + end};
}

NearbyVariance PointEstimates::NearbyOf(std::size_t point, std::size_t channel) const {
  NearbyVariances nearby;
  const auto [begin, end] = Neighbours(point, kNeighbours);
  for (std::size_t p = begin; p < end; ++p) {
    if (blocks_.blocks(p) == 0) continue;
    nearby.Add(blocks_.ReplicateVariance(p, 0, channel), blocks_.ReplicateVariance(p, 1, channel));
  }
  return nearby.Result();
}

VarianceRatio PointEstimates::RatioOf(std::size_t point, std::size_t channel) const {
  HalvesRatios ratios;
  const auto [begin, end] = Neighbours(point, kRatioNeighbours);
  for (std::size_t p = begin; p < end; ++p)
    if (!(alone_ && p == point)) ratios.Add(At(p, channel).own_ratio);
  return ratios.Result();
}

Missable PointEstimates::MissableBy(PointBlocks::Halves halves, std::size_t point, std::size_t channel) const {
  const PointSampler::Doubt& doubt = blocks_.doubt(point, channel);
  Missable missable;
  missable.largest = doubt.step + doubt.brightest;
  if (missable.largest == 0) return missable;
  const auto [begin, end] = Neighbours(point, kNeighbours);
  double variance = 0;
  double count = 0;
  for (std::size_t p = begin; p < end; ++p) {
    if (blocks_.blocks(p) == 0) continue;
    ++count;
    for (std::size_t half = halves.first; half < halves.last; ++half) {
      missable.seen = std::max(missable.seen, blocks_.range(p, half, channel).Width());
      variance += blocks_.SampleVariance(p, half, channel);
    }
  }
  missable.seen = std::min(missable.seen, missable.largest);
  missable.share = 1 / std::sqrt(count);
  missable.variance = variance / (count * static_cast<double>(halves.count()));
  return missable;
}

}  // namespace flatlight
