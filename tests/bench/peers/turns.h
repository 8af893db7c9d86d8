// SPDX-License-Identifier: Apache-2.0
// Times programs side by side on a machine that has other work too.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_TURNS_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_TURNS_H_

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace flatlight {

struct Contestant {
  std::string name;
  // Does items first, first + 1, ..., first + count - 1.
  std::function<void(std::size_t first, std::size_t count)> work;
};

struct TurnOptions {
  int rounds = 21;
  double slice = 0.005;  // Seconds, on average over the contestants.
};

struct Timing {
  double rate = 0;  // Items a second; the median of the rounds.
  // The first contestant's rate over this one's in the same round: above 1, the first is faster. Median and quartiles.
  double ratio = 0, ratio_q1 = 0, ratio_q3 = 0;
};

// In each round, each contestant in its turn does the same next items, after an untimed eighth as many that bring its
// data back into the caches. What counts is the processor time of this thread, so that being suspended costs nothing.
std::vector<Timing> TimeInTurns(const std::vector<Contestant>& contestants, std::size_t items, TurnOptions options);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_TURNS_H_
