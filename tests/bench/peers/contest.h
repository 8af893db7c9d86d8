// SPDX-License-Identifier: Apache-2.0
// What to compare programs on.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_CONTEST_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_CONTEST_H_

#include <vector>

#include "tests/bench/peers/turns.h"
#include "tests/bench/scattered_segments.h"

namespace flatlight {

struct ContestOptions {
  std::vector<int> sizes;  // Segments.
  std::vector<LengthRule> lengths;
  TurnOptions turns;
  bool timing = true;      // False: only checks that the programs agree.
  double emitting = 0.25;  // Exact light: the share of segments that shine.
};

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_CONTEST_H_
