// SPDX-License-Identifier: Apache-2.0
#include "core/render/ordered_work.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace flatlight {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kShardSeconds = 1e-3;
constexpr double kMostItemsPerShard = 1024;
constexpr double kShardsPerThread = 16;

}  // namespace

void OrderedWork::Advance(Executor& executor, int max_threads, const Cancellation& cancellation, const Clock& clock,
                          Clock::Duration budget, const Work& work) {
  const int threads = std::max(std::min(max_threads, executor.threads()), 1);
  const Clock::Time start = clock.Now();
  const double seconds_before = seconds_;
  Clock::Time now = start;
  while (!done() && !cancellation.cancelled()) {
    const double rounds = std::clamp(Seconds(budget - (now - start)).count() / kShardSeconds, 1.0, kShardsPerThread);
    const auto shard = static_cast<std::size_t>(items_per_shard_);
    const std::size_t left = items_ - done_items_;
    const std::size_t shards = std::min(
        (left + shard - 1) / shard, static_cast<std::size_t>(std::floor(rounds)) * static_cast<std::size_t>(threads));
    std::vector<char> complete(shards, 0);
    executor.ParallelFor(shards, threads, [&](std::size_t i) {
      const std::size_t first = done_items_ + i * shard;
      complete[i] = work(first, std::min(first + shard, items_)) ? 1 : 0;
    });
    const auto merged = static_cast<std::size_t>(std::find(complete.begin(), complete.end(), 0) - complete.begin());
    done_items_ = std::min(done_items_ + merged * shard, items_);
    const Clock::Time after = clock.Now();
    const double used_threads = static_cast<double>(std::min(static_cast<std::size_t>(threads), shards));
    const double worked = static_cast<double>(std::min(shards * shard, left));
    const double seconds_per_item = Seconds(after - now).count() * used_threads / worked;
    const double best = seconds_per_item > 0 ? kShardSeconds / seconds_per_item : kMostItemsPerShard;
    items_per_shard_ = std::clamp(std::min(best, 4 * items_per_shard_), 1.0, kMostItemsPerShard);
    now = after;
    seconds_ = seconds_before + Seconds(now - start).count();
    if (now - start >= budget) return;
  }
}

}  // namespace flatlight
