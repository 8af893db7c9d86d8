// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/refinement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace flatlight {
namespace {

// Of what is allowed in all, for panels that stay.
constexpr double kLeft = 0.5;
// Panels that add so much less than the worst wait until that one is better.
constexpr double kWaits = 3e-2;
constexpr double kShortest = 1e-12;
constexpr std::size_t kMostEvents = 6;
constexpr double kRatio = 0.25;
constexpr double kMostLeft = 0.9;
constexpr double kParts = 4;
constexpr double kEvenly = 0.1;
// Of the length of a panel: kinks nearer to its ends are taken to be there.
constexpr double kMargin = 1e-6;

// Where events at an end leave the rest as it was, that is halved too.
void HalveRest(const Panel& panel, std::vector<double>& places) {
  double from = panel.low, widest = 0, middle = 0;
  for (std::size_t i = 0; i <= places.size(); ++i) {
    const double to = i < places.size() ? places[i] : panel.high;
    if (to - from > widest) widest = to - from, middle = 0.5 * (from + to);
    from = to;
  }
  if (widest > kMostLeft * (panel.high - panel.low))
    places.insert(std::upper_bound(places.begin(), places.end(), middle), middle);
}

// The strongest inside of it.
const Event* StrongestIn(const Panel& panel, const std::vector<Event>& kinks) {
  const double margin = kMargin * (panel.high - panel.low);
  const Event* strongest = nullptr;
  auto kink = std::upper_bound(kinks.begin(), kinks.end(), panel.low + margin,
                               [](double u, const Event& event) { return u < event.u; });
  for (; kink != kinks.end() && kink->u < panel.high - margin; ++kink)
    if (!strongest || kink->strength > strongest->strength) strongest = &*kink;
  return strongest;
}

}  // namespace

std::vector<char> PanelsToSplit(const std::vector<double>& shares) {
  std::vector<std::size_t> order(shares.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return shares[a] != shares[b] ? shares[a] < shares[b] : a < b; });
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  const double most = shares.empty() ? 0 : shares[order.back()];
  std::vector<char> split(shares.size(), 0);
  double left = 0;
  for (const std::size_t i : order) {
    left += shares[i];
    split[i] = left > kLeft * std::min(1.0, all) && shares[i] > kWaits * most ? 1 : 0;
  }
  return split;
}

std::vector<double> SplitPlaces(const Panel& panel, const std::vector<Cell>& cells, const std::vector<double>& meetings,
                                const std::vector<Event>& kinks) {
  if (panel.high - panel.low < 4 * kShortest) return {};
  std::vector<double> places;
  if (cells.size() > kMostEvents + 1) {
    // In parts that are off by about as much.
    double all = 0, sum = 0, mean = 0;
    for (const Cell& cell : cells) mean += cell.off * (cell.high - cell.low) / (panel.high - panel.low);
    const auto part = [&](const Cell& cell) {
      return (mean > 0 ? cell.off + kEvenly * mean : 1) * (cell.high - cell.low);
    };
    for (const Cell& cell : cells) all += part(cell);
    std::size_t next = 1;
    for (std::size_t k = 0; k + 1 < cells.size(); ++k) {
      sum += part(cells[k]);
      if (sum * kParts < static_cast<double>(next) * all) continue;
      places.push_back(cells[k].high);
      while (static_cast<double>(next) * all <= sum * kParts) ++next;
    }
    if (!places.empty()) return places;
  }
  for (std::size_t k = 0; k + 1 < cells.size(); ++k) places.push_back(cells[k].high);
  if (!places.empty()) {
    HalveRest(panel, places);
    return places;
  }
  const auto meets = [&](double u) {
    return std::any_of(meetings.begin(), meetings.end(), [u](double m) { return std::abs(m - u) < kShortest; });
  };
  const bool low = meets(panel.low), high = meets(panel.high);
  const double length = panel.high - panel.low;
  if (low && high) return {panel.low + kRatio * length, panel.high - kRatio * length};
  if (low) return {panel.low + kRatio * length};
  if (high) return {panel.high - kRatio * length};
  const Event* const kink = StrongestIn(panel, kinks);
  if (kink == nullptr) return {panel.low + 0.5 * length};
  places.push_back(kink->u);
  HalveRest(panel, places);
  return places;
}

}  // namespace flatlight
