// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/turns.h"

#include <algorithm>
#include <cmath>

#include "tests/bench/bench_report.h"

namespace flatlight {
namespace {

// The items form a ring.
void Work(const Contestant& contestant, std::size_t items, std::size_t first, std::size_t count) {
  while (count > 0) {
    first %= items;
    const std::size_t now = std::min(count, items - first);
    contestant.work(first, now);
    first += now, count -= now;
  }
}

// Also warms up.
double SecondsAnItem(const Contestant& contestant, std::size_t items) {
  constexpr double kEnough = 0.004;
  for (std::size_t count = 1;; count *= 2) {
    const double start = ThreadSeconds();
    Work(contestant, items, 0, count);
    const double seconds = ThreadSeconds() - start;
    if (seconds > kEnough) return seconds / static_cast<double>(count);
  }
}

}  // namespace

std::vector<Timing> TimeInTurns(const std::vector<Contestant>& contestants, std::size_t items, TurnOptions options) {
  double seconds_an_item = 0;
  for (const Contestant& contestant : contestants) seconds_an_item += SecondsAnItem(contestant, items);
  const double wanted = options.slice * static_cast<double>(contestants.size()) / seconds_an_item;
  const auto count = static_cast<std::size_t>(std::max(8.0, std::ceil(wanted)));
  const std::size_t warm = count / 8;

  std::vector<std::vector<double>> rates(contestants.size()), ratios(contestants.size());
  for (int round = 0; round < options.rounds; ++round) {
    const std::size_t first = static_cast<std::size_t>(round) * count % items;
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      Work(contestants[i], items, first + (items - warm % items), warm);
      const double start = ThreadSeconds();
      Work(contestants[i], items, first, count);
      rates[i].push_back(static_cast<double>(count) / (ThreadSeconds() - start));
      ratios[i].push_back(rates[0].back() / rates[i].back());
    }
  }
  std::vector<Timing> timings;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    const Quartiles ratio = QuartilesOf(ratios[i]);
    timings.push_back({QuartilesOf(rates[i]).median, ratio.median, ratio.lower, ratio.upper});
  }
  return timings;
}

}  // namespace flatlight
