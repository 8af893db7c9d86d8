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
  GiveBackSpareMemory();
  const double before = ReadProcess().resident_bytes;
  std::vector<std::unique_ptr<char[]>> blocks;
  std::vector<std::unique_ptr<char[]>> kept;  // Among them: the C library gives nothing back by itself.
  for (std::size_t i = 0; i < kBlocks; ++i) {
    blocks.push_back(std::make_unique<char[]>(kBlockBytes));
    std::memset(blocks.back().get(), 1, kBlockBytes);
    if (i % 100 == 99) kept.push_back(std::make_unique<char[]>(100));
  }
  EXPECT_FALSE(GiveBackSpareMemory()) << "all of it is used";
  EXPECT_GT(ReadProcess().resident_bytes - before, 190e6);
  blocks.clear();
  EXPECT_GT(ReadProcess().resident_bytes - before, 190e6) << "the test frees nothing that would be kept";
  EXPECT_TRUE(GiveBackSpareMemory());
  EXPECT_LT(ReadProcess().resident_bytes - before, 20e6);
  EXPECT_FALSE(GiveBackSpareMemory()) << "there is no more of it";
}

}  // namespace
}  // namespace flatlight
