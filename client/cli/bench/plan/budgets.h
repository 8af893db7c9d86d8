// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_PLAN_BUDGETS_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_PLAN_BUDGETS_H_

#include <cstdint>
#include <vector>

namespace flatlight {

// 16, 64, 256, ... 16 777 216 samples: for --time-limit to end.
std::vector<std::uint32_t> DefaultBudgets();

// The seed of run `number` (from 0) with so many samples. Runs of different budgets have different seeds: with the same
// one, the smaller sample would be a part of the larger, and their errors alike. It depends on its arguments alone, so
// that more budgets or runs can be added later. Never kTruthSeed.
std::uint32_t SeedOfRun(std::uint32_t base, std::uint32_t budget, std::uint32_t number);

// Of a truth that is itself sampled.
inline constexpr std::uint32_t kTruthSeed = 4294967295;

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_PLAN_BUDGETS_H_
