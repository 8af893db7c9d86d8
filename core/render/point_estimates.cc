// SPDX-License-Identifier: Apache-2.0
#include "core/render/point_estimates.h"

#include <algorithm>
#include <cmath>

namespace flatlight {
namespace {

// Bright samples are looked for at so many points on either side: they get light in much the same ways.
constexpr std::size_t kNeighbours = 16;
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
        known.ratio.Add(HalvesRatios::SquaredError(values), estimate.variance);
      if (!alone_ && known.missable.largest > 0)
        known.misses.Add(HalvesSpreadOf(values), blocks_.OfMeans(point, known.missable).Event());
    }
  }
}

MeanEstimate PointEstimates::Of(std::size_t point, std::size_t channel) const {
  const Known& known = At(point, channel);
  NearbyVariance nearby = known.nearby;
  nearby.missed = MissedBy(point, channel);
  return RatioOf(point, channel).Of(blocks_.Estimate(point, channel, kBoth, known.missable, nearby));
}

MeanEstimate PointEstimates::OfHalf(std::size_t point, std::size_t half, std::size_t channel) const {
  const PointBlocks::Halves halves{half, half + 1};
  return RatioOf(point, channel)
      .Of(blocks_.Estimate(point, channel, halves, MissableBy(halves, point, channel), NearbyVariance()));
}

std::pair<std::size_t, std::size_t> PointEstimates::Neighbours(std::size_t point, std::size_t reach) const {
  return {std::max(first_, point - std::min(point, reach)), std::min(last_, point + reach + 1)};
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
    if (!(alone_ && p == point)) ratios.Add(At(p, channel).ratio);
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

std::optional<double> PointEstimates::MissedBy(std::size_t point, std::size_t channel) const {
  SharedMisses misses;
  const auto [begin, end] = Neighbours(point, kNeighbours);
  for (std::size_t p = begin; p < end; ++p) misses.Add(At(p, channel).misses);
  const Missable missable = blocks_.OfMeans(point, At(point, channel).missable);
  std::optional<double> missed =
      misses.MeanSquare((misses.any() ? missable.Event() : missable.largest) / kHalfReplicates);
  if (!missed) return missed;
  // A shadow's edge is met by a point that its neighbours know nothing of: any of them may be the one.
  const double step = blocks_.doubt(point, channel).step / static_cast<double>(blocks_.blocks(point));
  const double edge = missable.share * MostMissed(step, kReplicates);
  return *missed + edge * edge;
}

}  // namespace flatlight
