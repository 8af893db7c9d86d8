// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/refinement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/quadrature.h"

namespace flatlight {
namespace {

// Of what is allowed in all, for panels that stay.
constexpr double kLeft = 0.2;
// Panels that add so much less than the worst wait until that one is better.
constexpr double kWaits = 3e-2;
constexpr double kShortest = 1e-12;
constexpr std::size_t kMostEvents = 6;
constexpr double kRatio = 0.25;
constexpr double kMostLeft = 0.9;

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

std::vector<double> SplitPlaces(const Panel& panel, const Chart& chart, const std::vector<double>& meetings,
                                Outlook& outlook) {
  if (panel.high - panel.low < 4 * kShortest) return {};
  const auto sign_at = [&](double u) { return outlook.Signature(chart.ReceiverAt(panel.element, u, panel.side)); };
  constexpr std::size_t kLooks = 2 * kLightCoefficients;
  struct Change {
    double low, high;
    std::uint64_t sign;  // At the low end.
  };
  std::vector<Change> changes;
  double before = panel.At(-1 + 1e-7);
  std::uint64_t sign = sign_at(before);
  for (std::size_t i = 1; i <= kLooks && changes.size() <= kMostEvents; ++i) {
    const double x = 2 * static_cast<double>(i) / kLooks - 1;
    const double u = panel.At(std::min(x, 1 - 1e-7));
    const std::uint64_t next = sign_at(u);
    if (next != sign) changes.push_back({before, u, sign});
    before = u, sign = next;
  }
  // Where there are many, none is looked for.
  std::vector<double> places;
  if (changes.size() > kMostEvents) changes.clear();
  for (const Change& change : changes) {
    double low = change.low, high = change.high;
    for (double middle = 0.5 * (low + high); low < middle && middle < high && high - low > 1e-15;
         middle = 0.5 * (low + high))
      (sign_at(middle) == change.sign ? low : high) = middle;
    places.push_back(0.5 * (low + high));
  }
  if (!places.empty()) {
    // Events at an end leave the rest as it was.
    double from = panel.low, widest = 0, middle = 0;
    for (std::size_t i = 0; i <= places.size(); ++i) {
      const double to = i < places.size() ? places[i] : panel.high;
      if (to - from > widest) widest = to - from, middle = 0.5 * (from + to);
      from = to;
    }
    if (widest > kMostLeft * (panel.high - panel.low))
      places.insert(std::upper_bound(places.begin(), places.end(), middle), middle);
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
  return {panel.low + 0.5 * length};
}

}  // namespace flatlight
