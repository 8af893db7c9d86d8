// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_POINT_ESTIMATES_H_
#define FLATLIGHT_CORE_RENDER_POINT_ESTIMATES_H_

#include <cstddef>
#include <utility>
#include <vector>

#include "core/render/point_blocks.h"
#include "core/statistics/halves_ratio.h"
#include "core/statistics/misses_in_row.h"
#include "core/statistics/replicates.h"

namespace flatlight {

// What the samples of one probe's points say now. A point's own replicates tell little of its error: how noisy it is,
// what it may have missed and what its replicates gain by sharing sequences is told by its neighbours too.
class PointEstimates {
 public:
  // Of the points [first, last). Alone: where points stop by themselves each goes by its own spread, as one among
  // noisier ones would go on for their sake, and each half by its own samples; neighbours tell it no more than what
  // sharing sequences gains, and which samples are rare. The blocks must outlive this.
  PointEstimates(const PointBlocks& blocks, std::size_t first, std::size_t last, bool alone);

  // Of a point that has blocks.
  MeanEstimate Of(std::size_t point, std::size_t channel) const;
  // Of half of its replicates; points are alone.
  MeanEstimate OfHalf(std::size_t point, std::size_t half, std::size_t channel) const;
  // What the samples of some halves may have missed at a point, as the same halves of its neighbours tell.
  Missable MissableBy(PointBlocks::Halves halves, std::size_t point, std::size_t channel) const;

 private:
  // What a point knows of one channel. (Counts of points are equal but while a round is under way.)
  struct Known {
    Missable missable;
    NearbyVariance nearby;
    HalvesRatios own_ratio;
    VarianceRatio ratio;  // As neighbours tell, and the point unless it is alone.
  };
  Known& At(std::size_t point, std::size_t channel) { return known_[(point - first_) * blocks_.channels() + channel]; }
  const Known& At(std::size_t point, std::size_t channel) const {
    return known_[(point - first_) * blocks_.channels() + channel];
  }

  NearbyVariance NearbyOf(std::size_t point, std::size_t channel) const;
  VarianceRatio RatioOf(std::size_t point, std::size_t channel) const;
  // The points that are near: up to `reach` on either side.
  std::pair<std::size_t, std::size_t> Neighbours(std::size_t point, std::size_t reach) const;

  const PointBlocks& blocks_;
  std::size_t first_, last_;
  bool alone_;
  std::vector<Known> known_;         // Point, then channel.
  std::vector<MissesInRow> misses_;  // By channel; empty if points are alone.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_POINT_ESTIMATES_H_
