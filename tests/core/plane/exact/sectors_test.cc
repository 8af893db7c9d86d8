// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/sectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace flatlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Expected {
  double key;
  std::int32_t sight;
  double far_squared;
};

// Everything that may be asked, against a plain list.
void ExpectSame(const Sectors& sectors, const std::vector<Expected>& expected) {
  ASSERT_EQ(sectors.size(), expected.size());
  EXPECT_EQ(sectors[sectors.size()].key, 1);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(sectors[i].key, expected[i].key);
    EXPECT_EQ(sectors[i].sight, expected[i].sight);
    EXPECT_GE(sectors.FarSquared(i), expected[i].far_squared);
    EXPECT_LE(sectors.FarSquared(i), 1.00001 * expected[i].far_squared);
    EXPECT_EQ(sectors.Find(expected[i].key), i);
    EXPECT_EQ(sectors.Find(std::nextafter(expected[i].key, -2)), i == 0 ? 0 : i - 1);
    EXPECT_EQ(sectors.keys()[i], static_cast<float>(expected[i].key));
    EXPECT_EQ(static_cast<double>(sectors.far_squared()[i]), sectors.FarSquared(i));
  }
  for (std::size_t i = 0; i <= Sectors::kPadding; ++i) EXPECT_GT(sectors.keys()[sectors.size() + i], 2);
  std::size_t first = 0;
  for (std::size_t bin = 0; bin < Sectors::kBins; ++bin) {
    const double low = -1 + 2.0 * static_cast<double>(bin) / Sectors::kBins;
    while (first + 1 < expected.size() && expected[first + 1].key < low) ++first;
    EXPECT_EQ(sectors.First(bin), first) << bin;
  }
}

TEST(SectorsTest, SplitsAgreeWithAPlainList) {
  std::mt19937_64 random(5);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Sectors sectors;
  for (int round = 0; round < 20; ++round) {
    // Spread out, or crowded into one bin.
    const double width = round % 2 == 0 ? 2 : 0.01;
    sectors.Start(0, 1);
    std::vector<Expected> expected{{-1, Sector::kNothing, kInfinity}};
    for (int i = 0; i < 200; ++i) {
      const double key = std::max(-1 + 1e-9, std::min(1 - 1e-9, -1 + width * uniform()));
      const std::size_t at = sectors.Find(key);
      const double end = at + 1 < expected.size() ? expected[at + 1].key : 1;
      if (key == expected[at].key) continue;
      const Sector others[2] = {{key, i, 7}, {0.5 * (key + end), -1, 8}};
      const double far_squared[2] = {uniform(), uniform()};
      const std::size_t count = 1 + random() % 2;
      if (others[1].key <= key || others[1].key >= end) continue;
      sectors.Set(at, i, far_squared[1]);
      expected[at] = {expected[at].key, i, far_squared[1]};
      sectors.Split(at, others, far_squared, count);
      for (std::size_t j = 0; j < count; ++j) {
        expected.insert(expected.begin() + static_cast<std::ptrdiff_t>(at + 1 + j),
                        {others[j].key, others[j].sight, far_squared[j]});
      }
    }
    EXPECT_GT(expected.size(), 100u);
    ExpectSame(sectors, expected);
  }
}

}  // namespace
}  // namespace flatlight
