// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/plan/budgets.h"

namespace flatlight {
namespace {

constexpr std::uint32_t kFirst = 16;
constexpr std::uint32_t kStep = 4;
constexpr std::uint32_t kLast = 16'777'216;

// One to one on 32 bits, and every bit of x moves half of the bits: the finaliser of MurmurHash3 (A. Appleby).
std::uint32_t Mix(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x85ebca6b;
  x = (x ^ (x >> 13)) * 0xc2b2ae35;
  return x ^ (x >> 16);
}

}  // namespace

std::vector<std::uint32_t> DefaultBudgets() {
  std::vector<std::uint32_t> budgets;
  for (std::uint32_t budget = kFirst; budget <= kLast; budget *= kStep) budgets.push_back(budget);
  return budgets;
}

std::uint32_t SeedOfRun(std::uint32_t base, std::uint32_t budget, std::uint32_t number) {
  // One to one in `number`: no two runs of a point have the same seed, but for the one that makes way for the truth's.
  const std::uint32_t seed = Mix(Mix(base) ^ budget) + number;
  return seed == kTruthSeed ? seed - (1U << 31) : seed;
}

}  // namespace flatlight
