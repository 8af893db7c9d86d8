// SPDX-License-Identifier: Apache-2.0
#include "core/execution/thread_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <cstddef>
#include <thread>
#include <vector>

namespace flatlight {
namespace {

TEST(ThreadPoolTest, CallsEveryIndexOnce) {
  for (const int threads : {1, 2, 7}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (const std::size_t count : {0, 1, 2, 1000}) {
      std::vector<std::atomic<int>> calls(count);
      pool.ParallelFor(count, threads, [&](std::size_t i) { ++calls[i]; });
      for (const std::atomic<int>& n : calls) EXPECT_EQ(n, 1);
    }
  }
}

// Each piece waits for all others: it ends only if as many threads as asked for work at once.
TEST(ThreadPoolTest, UsesAllThreadsAskedFor) {
  ThreadPool pool(4);
  std::barrier together(4);
  pool.ParallelFor(4, 4, [&](std::size_t) { together.arrive_and_wait(); });
}

TEST(ThreadPoolTest, UsesNoMoreThanAskedFor) {
  ThreadPool pool(7);
  std::atomic<int> inside = 0;
  std::atomic<int> most = 0;
  pool.ParallelFor(2000, 2, [&](std::size_t) {
    const int now = ++inside;
    int seen = most;
    while (now > seen && !most.compare_exchange_weak(seen, now)) {
    }
    std::this_thread::yield();
    --inside;
  });
  EXPECT_LE(most, 2);
}

TEST(ThreadPoolTest, OneThreadMeansTheCaller) {
  ThreadPool pool(3);
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<std::thread::id> ids(50);
  pool.ParallelFor(ids.size(), 1, [&](std::size_t i) { ids[i] = std::this_thread::get_id(); });
  EXPECT_THAT(ids, testing::Each(caller));
}

TEST(ThreadPoolTest, ServesSeveralCallersAtOnce) {
  ThreadPool pool(3);
  std::atomic<int> calls = 0;
  std::vector<std::thread> callers;
  for (int c = 0; c < 5; ++c) {
    callers.emplace_back([&] {
      for (int round = 0; round < 50; ++round) pool.ParallelFor(20, 3, [&](std::size_t) { ++calls; });
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(calls, 5 * 50 * 20);
}

TEST(ThreadPoolTest, LoopsMayNest) {
  ThreadPool pool(2);
  std::atomic<int> calls = 0;
  pool.ParallelFor(8, 2, [&](std::size_t) { pool.ParallelFor(8, 2, [&](std::size_t) { ++calls; }); });
  EXPECT_EQ(calls, 64);
}

TEST(ThreadPoolTest, KnowsAtLeastOneProcessor) { EXPECT_GE(ThreadPool::AvailableProcessors(), 1); }

}  // namespace
}  // namespace flatlight
