// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/turns.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace flatlight {
namespace {

double ProcessorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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
    const double start = ProcessorSeconds();
    Work(contestant, items, 0, count);
    const double seconds = ProcessorSeconds() - start;
    if (seconds > kEnough) return seconds / static_cast<double>(count);
  }
}

// Linear between the two nearest values.
double Quantile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  const double place = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
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
      const double start = ProcessorSeconds();
      Work(contestants[i], items, first, count);
      rates[i].push_back(static_cast<double>(count) / (ProcessorSeconds() - start));
      ratios[i].push_back(rates[0].back() / rates[i].back());
    }
  }
  std::vector<Timing> timings;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    timings.push_back(
        {Quantile(rates[i], 0.5), Quantile(ratios[i], 0.5), Quantile(ratios[i], 0.25), Quantile(ratios[i], 0.75)});
  }
  return timings;
}

}  // namespace flatlight
