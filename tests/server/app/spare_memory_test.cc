// SPDX-License-Identifier: Apache-2.0
#include "server/app/spare_memory.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include "server/telemetry/process_readings.h"

namespace flatlight {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kOwnAllocator = true;  // Of the sanitizer, which keeps what is freed.
#else
constexpr bool kOwnAllocator = false;
#endif

TEST(SpareMemoryTest, WhatWasFreedGoesBackToTheSystem) {
  if (kOwnAllocator) GTEST_SKIP();
  constexpr std::size_t kBlockBytes = 64 << 10;  // Less than what is mapped by itself.
  constexpr std::size_t kBlocks = 3200;          // 200 MiB.
  GiveBackSpareMemory(false);
  const double before = ReadProcess().resident_bytes;
  const double heap_before = ReadProcess().heap_bytes;
  std::vector<std::unique_ptr<char[]>> blocks;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    blocks.push_back(std::make_unique<char[]>(kBlockBytes));
    std::memset(blocks.back().get(), 1, kBlockBytes);
  }
  EXPECT_FALSE(GiveBackSpareMemory(false)) << "all of it is used";
  EXPECT_GT(ReadProcess().resident_bytes - before, 190e6);
  EXPECT_GT(ReadProcess().heap_bytes - heap_before, 190e6);
  // Above what is freed some remains: the C library gives nothing back by itself.
  for (std::size_t i = 0; i < kBlocks; ++i) {
    if (i % 100 != 99) blocks[i].reset();
  }
  EXPECT_GT(ReadProcess().resident_bytes - before, 190e6) << "the test frees nothing that would be kept";
  EXPECT_LT(ReadProcess().heap_bytes - heap_before, 5e6) << "what was freed is not in use";
  EXPECT_TRUE(GiveBackSpareMemory(false));
  EXPECT_LT(ReadProcess().resident_bytes - before, 20e6);
  EXPECT_FALSE(GiveBackSpareMemory(false)) << "there is no more of it";
}

}  // namespace
}  // namespace flatlight
