// SPDX-License-Identifier: Apache-2.0
#include "core/render/point_blocks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <memory>

namespace flatlight {
namespace {

using Seconds = std::chrono::duration<double>;

// A shard should last about this long: work is cancelled and paced between shards, threads are kept busy with many.
constexpr double kShardSeconds = 1e-3;
constexpr double kMostBlocksPerShard = 4096;
// Between two merges each thread gets at most this many shards: enough to even out, few enough to hold in memory.
constexpr double kShardsPerThread = 24;

}  // namespace

PointBlocks::PointBlocks(const PointSampler& sampler, std::size_t points)
    : sampler_(sampler),
      channels_(sampler.channels()),
      trees_(points, BlockTree(Width())),
      doubts_(points * sampler.channels()),
      ranges_(points * 2 * sampler.channels()),
      variances_(points * 2 * sampler.channels()),
      spreads_(points * 2 * sampler.channels()) {}

void PointBlocks::UpdateVariances(std::size_t point) {
  const double samples = static_cast<double>(blocks(point)) * kHalfReplicates;
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t c = 0; c < channels_; ++c) {
      const double mean = trees_[point].Total(MomentColumn(half, c)) / samples;
      const double square = trees_[point].Total(MomentColumn(half, c) + 1) / samples;
      const std::size_t at = (point * 2 + half) * channels_ + c;
      variances_[at] = std::max(square - mean * mean, 0.0);
      std::array<double, kHalfReplicates> sums;
      for (std::size_t r = 0; r < kHalfReplicates; ++r)
        sums[r] = trees_[point].Total(c * kReplicates + half * kHalfReplicates + r);
      // Of the sum of a replicate to one sample.
      spreads_[at] = kHalfReplicates * EstimateMean(sums, 0).variance / static_cast<double>(blocks(point));
    }
  }
}

void PointBlocks::Resume() {
  first_open_ = 0;
  for (std::size_t point = 0; point < points(); ++point) {
    if (blocks(point) > 0) UpdateVariances(point);
  }
}

std::array<double, kReplicates> PointBlocks::Replicates(std::size_t point, std::size_t channel) const {
  std::array<double, kReplicates> means;
  for (std::size_t i = 0; i < kReplicates; ++i)
    means[i] = trees_[point].Total(channel * kReplicates + i) / static_cast<double>(blocks(point));
  return means;
}

Missable PointBlocks::OfMeans(std::size_t point, const Missable& missable) const {
  const auto blocks = static_cast<double>(this->blocks(point));
  Missable of_means = missable;
  of_means.seen /= blocks;
  of_means.largest /= blocks;
  return of_means;
}

MeanEstimate PointBlocks::Estimate(std::size_t point, std::size_t channel, Halves halves, const Missable& missable,
                                   const NearbyVariance& nearby) const {
  const std::array<double, kReplicates> means = Replicates(point, channel);
  const auto blocks = static_cast<double>(this->blocks(point));
  const std::size_t count = halves.count() * kHalfReplicates;
  Missable of_means = OfMeans(point, missable);
  of_means.variance /= blocks * static_cast<double>(count);
  NearbyVariance of_values = nearby;
  of_values.mean /= blocks;
  MeanEstimate estimate =
      EstimateMean(std::span(means).subspan(halves.first * kHalfReplicates, count), of_means, of_values);
  estimate.rounding = doubt(point, channel).rounding;
  return estimate;
}

void PointBlocks::SetGoals(std::vector<std::uint64_t> goals) {
  goals_ = std::move(goals);
  first_open_ = 0;
}

bool PointBlocks::Advance(Executor& executor, int max_threads, const Cancellation& cancellation, const Clock& clock,
                          Clock::Time until) {
  const int threads = std::max(std::min(max_threads, executor.threads()), 1);
  while (first_open_ < goals_.size() && blocks(first_open_) >= goals_[first_open_]) ++first_open_;
  Cursor cursor{first_open_, 0};
  Clock::Time now = clock.Now();
  while (!cancellation.cancelled()) {
    // As many shards as fit into the time left; one a thread while it isn't known how long they take.
    const double shard_seconds = std::max(std::floor(blocks_per_shard_) * seconds_per_block_, kShardSeconds);
    const double fitting = Seconds(until - now).count() / shard_seconds;
    const double rounds = std::clamp(fitting, 1.0, seconds_per_block_ > 0 ? kShardsPerThread : 1.0);
    const auto wanted = static_cast<std::size_t>(std::floor(rounds) * threads);
    std::vector<Shard> shards;
    while (shards.size() < wanted) {
      Shard shard = CutShard(cursor);
      if (shard.pieces.empty()) break;
      shards.push_back(std::move(shard));
    }
    if (shards.empty()) return true;
    // They may take longer than was measured: those whose turn comes too late are left.
    executor.ParallelFor(shards.size(), threads, [&](std::size_t i) {
      if (i == 0 || clock.Now() < until) Work(shards[i], cancellation);
    });
    const double blocks_before = total_blocks_;
    const bool all = Merge(shards);
    const double done = total_blocks_ - blocks_before;
    const Clock::Time after = clock.Now();
    const double used_threads = std::min(static_cast<double>(threads), static_cast<double>(shards.size()));
    if (done > 0) seconds_per_block_ = Seconds(after - now).count() * used_threads / done;
    if (!all) return false;
    // Grow by steps: a first measurement of tiny shards is mostly overhead.
    const double best = seconds_per_block_ > 0 ? kShardSeconds / seconds_per_block_ : kMostBlocksPerShard;
    blocks_per_shard_ = std::clamp(std::min(best, 4 * blocks_per_shard_), 1.0, kMostBlocksPerShard);
    now = after;
    if (now >= until) {
      Cursor rest = cursor;
      return CutShard(rest).pieces.empty();
    }
  }
  return false;
}

PointBlocks::Shard PointBlocks::CutShard(Cursor& cursor) const {
  Shard shard;
  auto room = static_cast<std::uint64_t>(blocks_per_shard_);
  while (room > 0 && cursor.point < goals_.size()) {
    const std::uint64_t first = std::max(cursor.block, blocks(cursor.point));
    const std::uint64_t goal = goals_[cursor.point];
    if (first >= goal) {
      ++cursor.point;
      cursor.block = 0;
      continue;
    }
    const auto max_level = static_cast<unsigned>(std::bit_width(room) - 1);
    const unsigned level = BlockTree::AlignedLevel(first, goal, max_level);
    shard.pieces.push_back({cursor.point, first, level});
    cursor.block = first + (std::uint64_t{1} << level);
    room -= std::uint64_t{1} << level;
  }
  return shard;
}

void PointBlocks::Work(Shard& shard, const Cancellation& cancellation) const {
  const std::size_t width = Width();
  std::vector<double> block(width);
  shard.nodes.resize(shard.pieces.size() * width);
  shard.ranges.resize(shard.pieces.size() * 2 * channels_);
  shard.rays.resize(shard.pieces.size());
  for (std::size_t i = 0; i < shard.pieces.size(); ++i) {
    const Piece& piece = shard.pieces[i];
    BlockTree tree(width);
    const std::unique_ptr<const PointSampler::Source> source = sampler_.At(piece.point);
    for (std::uint64_t k = 0; k < (std::uint64_t{1} << piece.level); ++k) {
      std::fill(block.begin(), block.end(), 0.0);
      source->AddBlock(static_cast<std::uint32_t>(piece.first + k), cancellation,
                       std::span(block).first(channels_ * kReplicates), shard.rays[i]);
      if (cancellation.cancelled()) return;
      for (std::size_t c = 0; c < channels_; ++c) {
        for (std::size_t r = 0; r < kReplicates; ++r) {
          const std::size_t half = r / kHalfReplicates;
          const double sample = block[c * kReplicates + r];
          shard.ranges[(i * 2 + half) * channels_ + c].Add(sample);
          block[MomentColumn(half, c)] += sample;
          block[MomentColumn(half, c) + 1] += sample * sample;
        }
      }
      tree.Append(0, block);
    }
    tree.Total(std::span(shard.nodes).subspan(i * width, width));
  }
  shard.complete = true;
}

bool PointBlocks::Merge(const std::vector<Shard>& shards) {
  const std::size_t width = Width();
  bool all = true;
  for (const Shard& shard : shards) {
    all = all && shard.complete;
    if (!shard.complete) continue;
    for (std::size_t i = 0; i < shard.pieces.size(); ++i) {
      const Piece& piece = shard.pieces[i];
      // Blocks after a gap that an incomplete shard left are done again later.
      if (blocks(piece.point) != piece.first) continue;
      rays_ += shard.rays[i];
      if (piece.first == 0) {
        sampler_.Doubts(piece.point, std::span(doubts_).subspan(piece.point * channels_, channels_));
      }
      trees_[piece.point].Append(piece.level, std::span(shard.nodes).subspan(i * width, width));
      for (std::size_t k = 0; k < 2 * channels_; ++k) {
        ranges_[piece.point * 2 * channels_ + k].Add(shard.ranges[i * 2 * channels_ + k]);
      }
      UpdateVariances(piece.point);
      total_blocks_ += std::ldexp(1.0, static_cast<int>(piece.level));
    }
  }
  return all;
}

}  // namespace flatlight
