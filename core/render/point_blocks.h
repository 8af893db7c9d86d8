// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_POINT_BLOCKS_H_
#define FLATLIGHT_CORE_RENDER_POINT_BLOCKS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/render/point_sampler.h"
#include "core/statistics/block_tree.h"
#include "core/statistics/replicates.h"
#include "core/statistics/sample_range.h"

namespace flatlight {

// The blocks done at every point, and the work that adds to them. Where a point's blocks are cut into shards, and who
// works on them, leaves no trace in the sums.
class PointBlocks {
 public:
  static constexpr std::uint64_t kMostBlocks = std::uint64_t{1} << 31;  // Indices of samples have 32 bits.

  // The sampler must outlive this.
  PointBlocks(const PointSampler& sampler, std::size_t points);

  std::size_t points() const { return trees_.size(); }
  std::size_t channels() const { return channels_; }
  std::uint64_t blocks(std::size_t point) const { return trees_[point].blocks(); }
  double total_blocks() const { return total_blocks_; }
  double rays() const { return rays_; }

  // What is known of a point that has blocks beside its samples.
  const PointSampler::Doubt& doubt(std::size_t point, std::size_t channel) const {
    return doubts_[point * channels_ + channel];
  }
  // Of the samples of one half of the replicates.
  const SampleRange& range(std::size_t point, std::size_t half, std::size_t channel) const {
    return ranges_[(point * 2 + half) * channels_ + channel];
  }

  // The variance of a single sample, whatever its replicate, as those of one half tell it.
  double SampleVariance(std::size_t point, std::size_t half, std::size_t channel) const {
    return variances_[(point * 2 + half) * channels_ + channel];
  }

  // The variance of one sample of a replicate, as the means of the replicates of one half tell it.
  double ReplicateVariance(std::size_t point, std::size_t half, std::size_t channel) const {
    return spreads_[(point * 2 + half) * channels_ + channel];
  }

  // The halves [first, last) of the replicates.
  struct Halves {
    std::size_t first = 0;
    std::size_t last = 2;
    std::size_t count() const { return last - first; }
  };
  // The means of the replicates of a point that has blocks.
  std::array<double, kReplicates> Replicates(std::size_t point, std::size_t channel) const;
  // Of a point that has blocks; of single samples, to of means of that many.
  Missable OfMeans(std::size_t point, const Missable& missable) const;
  // The estimate from some halves of a point that has blocks. `missable` and `nearby` are of single samples, not of
  // replicates' means, but for nearby.missed, which is of those.
  MeanEstimate Estimate(std::size_t point, std::size_t channel, Halves halves, const Missable& missable,
                        const NearbyVariance& nearby) const;

  // What to bring each point up to: one number of blocks a point; points that are further stay.
  void SetGoals(std::vector<std::uint64_t> goals);
  // Works toward the goals, point after point. Returns true when all are reached, false if `until` has come or work was
  // cancelled first. Always does something unless cancelled.
  bool Advance(Executor& executor, int max_threads, const Cancellation& cancellation, const Clock& clock,
               Clock::Time until);

  // For a stream of states: the blocks done and the goals.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream.Filled(self.trees_);
    stream(self.goals_);
    stream.Filled(self.doubts_);
    stream.Filled(self.ranges_);
    stream(self.total_blocks_, self.rays_);
    stream.Require(self.goals_.empty() || self.goals_.size() == self.trees_.size());
    if constexpr (!std::is_const_v<Self>) {
      if (stream.ok()) self.Resume();
    }
  }

 private:
  // The blocks [first, first + 2^level) of a point.
  struct Piece {
    std::size_t point = 0;
    std::uint64_t first = 0;
    unsigned level = 0;
  };
  struct Shard {
    std::vector<Piece> pieces;
    std::vector<double> nodes;        // Sums, one node a piece.
    std::vector<SampleRange> ranges;  // Piece, then half, then channel.
    std::vector<double> rays;         // Of each piece.
    bool complete = false;
  };
  // The next work in order.
  struct Cursor {
    std::size_t point = 0;
    std::uint64_t block = 0;  // 0: where the point stands.
  };

  Shard CutShard(Cursor& cursor) const;
  void Work(Shard& shard, const Cancellation& cancellation) const;
  // Finds again what follows from the blocks.
  void Resume();
  // Brings variances_ and spreads_ up to the blocks of a point.
  void UpdateVariances(std::size_t point);
  // True if everything was complete.
  bool Merge(const std::vector<Shard>& shards);

  // A node: for each channel the sums of replicates; then, for each half and channel, of samples and their squares.
  std::size_t Width() const { return channels_ * (kReplicates + 4); }
  std::size_t MomentColumn(std::size_t half, std::size_t channel) const {
    return channels_ * kReplicates + 2 * (half * channels_ + channel);
  }

  const PointSampler& sampler_;
  std::size_t channels_;
  std::vector<BlockTree> trees_;
  std::vector<std::uint64_t> goals_;
  std::size_t first_open_ = 0;               // No point before it is short of its goal.
  std::vector<PointSampler::Doubt> doubts_;  // Point, then channel.
  std::vector<SampleRange> ranges_;          // Point, then half, then channel.
  std::vector<double> variances_;            // Likewise.
  std::vector<double> spreads_;              // Likewise: ReplicateVariance.
  double total_blocks_ = 0;
  double rays_ = 0;
  // How to cut work: measured, without influence on sums.
  double blocks_per_shard_ = 1;
  double seconds_per_block_ = 0;  // On one thread; 0: unknown.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_POINT_BLOCKS_H_
