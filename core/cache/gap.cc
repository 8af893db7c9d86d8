// SPDX-License-Identifier: Apache-2.0
#include "core/cache/gap.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "core/cache/record_pair.h"

namespace flatlight {
namespace {

// A record is wanted at most so many times as densely at one end of a gap as at the other.
constexpr double kSteepest = 8;
constexpr double kMostError = 1;        // Relative; more tells no more.
constexpr double kLeftOfUnknown = 0.1;  // Of the distance of records, at the ends of where nothing is known yet.

double Power(double base, std::size_t exponent) {
  double power = 1;
  for (std::size_t k = 0; k < exponent; ++k) power *= base;
  return power;
}

// About the power-th root, which sizes the distance at which an error that grows with this power is reached.
double Root(double value, std::size_t power) {
  return power == 1 ? value : power == 2 ? std::sqrt(value) : std::sqrt(std::sqrt(value));
}

// Of `count` records toward a corner, by number from it: distances from it shrink by the square, and none is in it.
double Graded(double number, double count) {
  const double root = (number + 0.5) / (count + 0.5);
  return root * root;
}

// The place in [0, 1] below which there is a share of a density that goes from `first` to `last`.
double Quantile(double share, double first, double last) {
  const double slope = last - first, mean = 0.5 * (first + last);
  // first u + slope u^2/2 = share mean
  return 2 * share * mean / (first + std::sqrt(std::max(0.0, first * first + 2 * slope * share * mean)));
}

}  // namespace

double Gap::ErrorWith(std::size_t count, std::size_t power) const {
  if (count == 0) return error;
  if (count >= points.size()) return 0;
  if (joins) return JoinedErrorWith(count, power);
  if (Halves() > 0)
    return error * Power(static_cast<double>(Halves()) / static_cast<double>(Halves() + 2 * count), power);
  // Nothing vouches for it yet: it may be no better than what lies beside.
  return error / Power(static_cast<double>(2 * count), power);
}

double Gap::JoinedErrorWith(std::size_t count, std::size_t power) const {
  const double n = static_cast<double>(count);
  if (before && after) return error / Power(n + 1, 2 * power);
  // If derivatives grow as those of 1/x do, what an error of extrapolation over a distance is to irradiance its square
  // is to what joined records leave between them over twice that distance.
  const double most = std::min(error, kMostError);
  if (before || after) {
    const double joined = most * most / Power(2 * n, 2 * power);
    // The last one before a corner is not joined, and what is left of x log x falls with its distance alone.
    const bool corner = before ? corners.high : corners.low;
    return corner ? std::max(joined, most * Graded(0, n)) : joined;
  }
  return count == 1 ? most / Power(2, power) : most * most / Power(4 * (n - 1), 2 * power);
}

double Gap::ShareOf(std::size_t number, std::size_t count) const {
  const double n = static_cast<double>(count), k = static_cast<double>(number);
  if (!joins) return (2 * k + 1 + (before ? 1 : 0)) / (2 * n + static_cast<double>(Halves()));
  if (before && after) return (k + 1) / (n + 1);
  if (before) return corners.high ? 1 - Graded(n - 1 - k, n) : (k + 1) / n;
  if (after) return corners.low ? Graded(k, n) : k / n;
  return count == 1 ? 0.5 : (k + kLeftOfUnknown) / (n - 1 + 2 * kLeftOfUnknown);
}

std::vector<double> Gap::Places(std::size_t count, std::size_t power) const {
  std::vector<double> free;
  for (const double point : points)
    if (!(before && point == before->at) && !(after && point == after->at)) free.push_back(point);
  free.erase(std::unique(free.begin(), free.end()), free.end());
  if (count >= free.size()) return free;
  const double width = high - low;
  double first = before ? Root(before->SmoothError(0.5 * width), power) : 0;
  double last = after ? Root(after->SmoothError(0.5 * width), power) : 0;
  if (!before) first = last;
  if (!after) last = first;
  const double most = std::max(first, last);
  first = most > 0 && std::isfinite(most) ? std::max(first / most, 1 / kSteepest) : 1;
  last = most > 0 && std::isfinite(most) ? std::max(last / most, 1 / kSteepest) : 1;
  std::vector<double> places;
  for (std::size_t k = 0; k < count; ++k) {
    const double place = low + width * Quantile(ShareOf(k, count), first, last);
    // The nearest point that is left, and enough of them for those still to come.
    const auto begin = places.empty() ? free.begin() : std::upper_bound(free.begin(), free.end(), places.back());
    const auto end = free.end() - static_cast<std::ptrdiff_t>(count - k - 1);
    auto next = std::lower_bound(begin, end, place);
    if (next == end || (next != begin && place - *std::prev(next) < *next - place)) --next;
    places.push_back(*next);
  }
  return places;
}

std::vector<Gap> FindGaps(std::span<const double> points, std::span<const CacheRecord* const> records,
                          const TrackCorners& corners) {
  std::vector<Gap> gaps;
  std::size_t next = 0;  // Among the points.
  const auto add = [&](const CacheRecord* before, const CacheRecord* after, double low, double high, bool closed,
                       const CacheRecord* left, const CacheRecord* right) {
    Gap gap;
    gap.before = before, gap.after = after, gap.low = low, gap.high = high;
    gap.corners = {corners.low && !left, corners.high && !right};
    gap.joins = left ? left->goes_on : right && right->goes_on;
    std::optional<RecordPair> pair;
    if (before && after && RecordPair::Joins(*before, *after)) pair.emplace(*before, *after, before->degree);
    const std::size_t begin = next;
    while (next < points.size() && (closed ? points[next] <= high : points[next] < high)) {
      double error = std::numeric_limits<double>::infinity();
      if (pair) {
        error = pair->CostAt(std::max(points[next], low));
      } else {
        for (const CacheRecord* record : {left, right})
          if (record) error = std::min(error, record->CostAt(points[next]));
      }
      gap.error = std::max(gap.error, error);
      const double counted = std::min(error, Gap::kFarOff);
      gap.squares += counted * counted;
      ++next;
    }
    gap.points = points.subspan(begin, next - begin);
    // The wanted part alone.
    if (!gap.points.empty()) {
      if (!gap.before) gap.low = std::max(gap.low, gap.points.front());
      if (!gap.after) gap.high = std::min(gap.high, gap.points.back());
      gaps.push_back(gap);
    }
  };
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i <= records.size(); ++i) {
    const CacheRecord* left = i > 0 ? records[i - 1] : nullptr;
    const CacheRecord* right = i < records.size() ? records[i] : nullptr;
    const double low = left ? left->at : -infinity, high = right ? right->at : infinity;
    const double left_end = left ? std::min(left->at + left->EventToRight(), high) : -infinity;
    const double right_end = right ? std::max(right->at - right->EventToLeft(), low) : infinity;
    if (left_end >= high && right_end <= low) {
      add(left, right, low, high, !right, left, right);
      continue;
    }
    // At an event itself the right side counts.
    if (left) add(left, nullptr, low, std::min(left_end, high), left_end >= high && !right, left, right);
    const double unknown_end = right ? right_end : infinity;
    if (!(left && left_end >= high))
      add(nullptr, nullptr, left ? left_end : -infinity, unknown_end, !right, left, right);
    if (right) add(nullptr, right, right_end, high, false, left, right);
  }
  return gaps;
}

}  // namespace flatlight
