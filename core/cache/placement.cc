// SPDX-License-Identifier: Apache-2.0
#include "core/cache/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <span>
#include <utility>

#include "core/cache/gap.h"
#include "core/math/check.h"

namespace flatlight {
namespace {

constexpr std::size_t kFirstRecords = 3;  // Of a track.
constexpr std::size_t kMostAtOnce = 4;    // Into a gap, for its estimate tells little about what lies far inside.
constexpr std::ptrdiff_t kBeside = 2;     // Records to each side of a point that are asked.

// So much less than the tolerance records of an overture are placed for (pbrt's priming asks for as much more weight).
constexpr double kOverture = 1.5;

// The largest distance up to `most` at which the error is at most `error`.
double RadiusFor(const CacheRecord& record, double error, double most) {
  double high = most;
  if (record.SmoothError(high) <= error) return high;
  double low = 0;
  for (int step = 0; step < 200; ++step) {
    const double middle = 0.5 * (low + high);
    if (!(low < middle && middle < high)) break;
    (record.SmoothError(middle) <= error ? low : high) = middle;
  }
  return low;
}

// A radius that takes in a point.
double Beyond(double distance) { return distance * (1 + 0x1p-20) + std::numeric_limits<double>::min(); }

}  // namespace

Placement::Placement(std::vector<std::vector<double>> points, const PlacementOptions& options)
    : points_(std::move(points)), options_(options) {
  FLATLIGHT_DCHECK(!options_.most_records || *options_.most_records >= points_.size());
}

std::vector<std::vector<CacheRecord*>> Placement::Sorted(std::vector<CacheRecord>& records) const {
  std::vector<std::vector<CacheRecord*>> sorted(points_.size());
  for (CacheRecord& record : records) sorted[record.track].push_back(&record);
  for (std::vector<CacheRecord*>& track : sorted)
    std::stable_sort(track.begin(), track.end(), [](const auto* a, const auto* b) { return a->at < b->at; });
  return sorted;
}

std::vector<RecordPlace> Placement::First(const std::vector<std::uint32_t>& tracks, std::size_t most) const {
  std::vector<std::size_t> counts(tracks.size(), kFirstRecords);
  if (options_.most_records) {
    // A third of them, and no track without.
    const std::size_t first = std::max((most + 2) / 3, tracks.size());
    double all = 0;
    for (const std::uint32_t t : tracks) all += Extent(t);
    std::size_t left = first - tracks.size();
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      const double share = all > 0 ? Extent(tracks[i]) / all * static_cast<double>(first - tracks.size()) : 0;
      const auto more = std::min(left, static_cast<std::size_t>(std::floor(share + 0.5)));
      counts[i] = 1 + more, left -= more;
    }
    // As many as there are stretches between events, if that is not too many.
    std::vector<std::size_t> enough = counts;
    std::size_t sum = 0;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      enough[i] = Stretches(tracks[i]).size();
      // One that knows its derivatives tells where the others belong.
      if (options_.control != ErrorControl::kVisibilityEvents) enough[i] = std::max(enough[i], counts[i]);
      sum += enough[i];
    }
    if (3 * sum <= 2 * most) counts = enough;
  }
  std::vector<RecordPlace> places;
  for (std::size_t i = 0; i < tracks.size(); ++i)
    for (const double at : FirstOf(tracks[i], counts[i])) places.push_back({tracks[i], at});
  return places;
}

std::vector<Gap> Placement::Stretches(std::uint32_t track) const {
  const std::span<const double> points = points_[track];
  std::vector<Gap> stretches;
  std::size_t first = 0;
  const auto add = [&](std::size_t end) {
    if (end == first) return;
    Gap& gap = stretches.emplace_back();
    gap.points = points.subspan(first, end - first);
    gap.low = gap.points.front(), gap.high = gap.points.back();
    first = end;
  };
  if (track < events_.size()) {
    for (const VisibilityEvent& event : events_[track])
      // Records are joined across the others.
      if (!event.known)
        add(static_cast<std::size_t>(std::lower_bound(points.begin(), points.end(), event.at) - points.begin()));
  }
  add(points.size());
  return stretches;
}

std::vector<double> Placement::FirstOf(std::uint32_t track, std::size_t count) const {
  std::vector<Gap> stretches = Stretches(track);
  if (!options_.most_records || stretches.size() > count) {
    Gap all;
    all.points = points_[track], all.low = all.points.front(), all.high = all.points.back();
    return all.Places(count, 1);
  }
  std::vector<std::size_t> counts(stretches.size(), 1);
  for (std::size_t left = count - stretches.size(); left > 0; --left) {
    const auto each = [&](std::size_t i) {
      return (stretches[i].high - stretches[i].low) / static_cast<double>(counts[i]);
    };
    std::size_t widest = 0;
    for (std::size_t i = 1; i < stretches.size(); ++i)
      if (each(i) > each(widest)) widest = i;
    ++counts[widest];
  }
  std::vector<double> places;
  for (std::size_t i = 0; i < stretches.size(); ++i)
    for (const double at : stretches[i].Places(counts[i], 1)) places.push_back(at);
  return places;
}

void Placement::ClampNeighbours(const std::vector<CacheRecord*>& track, double extent) const {
  std::vector<double> radius;
  radius.reserve(track.size());
  for (const CacheRecord* record : track) radius.push_back(RadiusFor(*record, options_.tolerance, extent));
  std::vector<double> clamped = radius;
  for (std::size_t i = 1; i < track.size(); ++i)
    clamped[i] = std::min(clamped[i], clamped[i - 1] + (track[i]->at - track[i - 1]->at));
  for (std::size_t i = track.size(); i-- > 1;)
    clamped[i - 1] = std::min(clamped[i - 1], clamped[i] + (track[i]->at - track[i - 1]->at));
  for (std::size_t i = 0; i < track.size(); ++i) {
    if (!(clamped[i] > 0 && clamped[i] < radius[i])) continue;
    // The same error at so many times smaller a distance.
    double stretch = 1;
    for (double& growth : track[i]->growth) growth *= stretch, stretch *= radius[i] / clamped[i];
  }
}

std::vector<RecordPlace> Placement::Next(std::vector<CacheRecord>& records) const {
  const std::size_t power = GrowthPower(options_.control, options_.degree);
  const auto sorted = Sorted(records);
  const std::size_t budget = options_.most_records.value_or(0), left = budget - std::min(budget, records.size());
  std::vector<std::uint32_t> bare;
  for (std::size_t t = 0; t < points_.size(); ++t)
    if (sorted[t].empty()) bare.push_back(static_cast<std::uint32_t>(t));
  if (!bare.empty()) return First(bare, left);
  const double tolerance = options_.tolerance / (options_.overture ? kOverture : 1);
  struct Candidate {
    std::uint32_t track;
    Gap gap;
    std::size_t count = 0;
  };
  std::vector<Candidate> candidates;
  for (std::size_t t = 0; t < points_.size(); ++t) {
    ErrorScale scale;
    scale.of_mean = options_.most_records.has_value();
    scale.extent = Extent(t);
    for (const CacheRecord* record : sorted[t])
      scale.mean += record->Irradiance() / static_cast<double>(sorted[t].size());
    for (CacheRecord* record : sorted[t]) SetErrors(options_.control, options_.degree, scale, *record);
    if (options_.clamp_neighbours) ClampNeighbours(sorted[t], scale.extent);
    const std::vector<const CacheRecord*> known(sorted[t].begin(), sorted[t].end());
    for (const Gap& gap : FindGaps(points_[t], known, t < corners_.size() ? corners_[t] : TrackCorners()))
      candidates.push_back({static_cast<std::uint32_t>(t), gap});
  }
  if (options_.most_records) {
    // All that is left is planned for where the error is largest; if there is a good estimate of it, where it takes
    // most off the sum of squares.
    const auto gain = [&](const Candidate& c) {
      const double now = std::min(c.gap.ErrorWith(c.count, power), Gap::kFarOff);
      if (options_.control != ErrorControl::kVisibilityEvents || c.gap.error == 0) return now;
      const double then = std::min(c.gap.ErrorWith(c.count + 1, power), Gap::kFarOff);
      const double error = std::min(c.gap.error, Gap::kFarOff);
      return c.gap.squares * (now - then) * (now + then) / (error * error);
    };
    std::priority_queue<std::pair<double, std::size_t>> best;
    for (std::size_t i = candidates.size(); i-- > 0;) best.emplace(gain(candidates[i]), i);
    for (std::size_t planned = 0; planned < left && !best.empty(); ++planned) {
      const auto [most, i] = best.top();
      best.pop();
      if (!(most > 0)) break;
      ++candidates[i].count;
      best.emplace(gain(candidates[i]), i);
    }
    // Where most is planned it is done, at least half of it; what that finds may change the rest of the plan.
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.count > b.count; });
    std::size_t done = 0;
    for (Candidate& c : candidates) {
      if (2 * done >= left) c.count = 0;
      done += c.count;
    }
  } else {
    for (Candidate& c : candidates)
      while (c.count < kMostAtOnce && c.gap.ErrorWith(c.count, power) > tolerance) ++c.count;
  }
  std::vector<RecordPlace> places;
  for (const Candidate& c : candidates) {
    if (c.count == 0) continue;
    for (const double at : c.gap.Places(c.count, power)) places.push_back({c.track, at});
  }
  return places;
}

void Placement::SetFootprints(std::vector<CacheRecord>& records) const {
  const auto sorted = Sorted(records);
  // Of the records beside a point.
  const auto beside = [&](const std::vector<CacheRecord*>& track, double point) {
    const auto after = std::upper_bound(track.begin(), track.end(), point,
                                        [](double x, const CacheRecord* record) { return x < record->at; });
    const std::ptrdiff_t i = after - track.begin(), size = std::ssize(track);
    return std::span<CacheRecord* const>(track.begin() + std::max<std::ptrdiff_t>(i - kBeside, 0),
                                         track.begin() + std::min<std::ptrdiff_t>(i + kBeside, size));
  };
  const auto nearest = [&](const std::vector<CacheRecord*>& track, double point) {
    CacheRecord* best = nullptr;
    for (CacheRecord* record : beside(track, point))
      if (!best || record->CostAt(point) < best->CostAt(point)) best = record;
    return best;
  };
  // One error for all, which is enough everywhere.
  double error = options_.tolerance;
  if (options_.most_records && options_.control != ErrorControl::kVisibilityEvents) {
    error = 0;
    for (std::size_t t = 0; t < points_.size(); ++t)
      for (const double point : points_[t]) error = std::max(error, nearest(sorted[t], point)->CostAt(point));
  }
  for (std::size_t t = 0; t < points_.size(); ++t) {
    const std::vector<CacheRecord*>& track = sorted[t];
    for (std::size_t i = 0; i < track.size(); ++i) {
      CacheRecord& record = *track[i];
      const double far = Extent(t) + std::abs(record.at - points_[t].front()) + std::abs(record.at - points_[t].back());
      double left = far, right = far;
      if (options_.control != ErrorControl::kSplitSphere && options_.control != ErrorControl::kBoundedSplitSphere) {
        // A derivative may vanish, and the error does not; beyond its neighbours a record knows less than they do.
        if (i > 0) left = record.at - track[i - 1]->at;
        if (i + 1 < track.size()) right = track[i + 1]->at - record.at;
      }
      if (options_.control == ErrorControl::kVisibilityEvents) {
        // Neighbours are joined (RecordPair).
        record.left_radius = std::min(left, record.EventToLeft());
        record.right_radius = std::min(right, record.EventToRight());
      } else {
        record.left_radius = RadiusFor(record, error, std::min(left, record.EventToLeft()));
        record.right_radius = RadiusFor(record, error, std::min(right, record.EventToRight()));
      }
    }
    for (const double point : points_[t]) {
      const auto covers = [&](const CacheRecord* record) {
        const double d = point - record->at;
        return d < 0 ? -d < record->left_radius : d < record->right_radius || d == 0;
      };
      const auto candidates = beside(track, point);
      if (std::any_of(candidates.begin(), candidates.end(), covers)) continue;
      CacheRecord* const record = nearest(track, point);
      const double distance = Beyond(std::abs(point - record->at));
      (point < record->at ? record->left_radius : record->right_radius) = distance;
    }
  }
}

}  // namespace flatlight
