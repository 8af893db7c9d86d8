// SPDX-License-Identifier: Apache-2.0
// Where records are made: in waves, each of which knows the records of those before.
#ifndef FLATLIGHT_CORE_CACHE_PLACEMENT_H_
#define FLATLIGHT_CORE_CACHE_PLACEMENT_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/cache/error_control.h"
#include "core/cache/gap.h"
#include "core/cache/record.h"

namespace flatlight {

struct PlacementOptions {
  ErrorControl control = ErrorControl::kVisibilityEvents;
  std::size_t degree = 2;   // Of extrapolation.
  double tolerance = 0.01;  // The largest estimated relative error at a point,
  // or as little as this number of records can do; at least one a track.
  std::optional<std::size_t> most_records = {};
  // Where a record's error reaches the tolerance, its neighbours' does so no further away than their distance allows:
  // what one knows of small features others heed (Krivanek et al. 2006; THEORY 7).
  bool clamp_neighbours = false;
  // Records are placed for less than the tolerance and then used up to it: those of a first pass, of which more than
  // one count at most points (as the overture of Mitsuba and the priming of pbrt).
  bool overture = false;
};

struct RecordPlace {
  std::uint32_t track = 0;
  double at = 0;

  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.track, self.at);
  }
};

// A track is a stretch along which irradiance is smooth but for visibility events: one side of a straight or smoothly
// bent piece of a curve. Records count on their own track alone, so that nothing leaks through walls or around corners.
// Places are a function of the points and the records, never of who made them when.
class Placement {
 public:
  // `points`: by track, where irradiance is wanted, in order of the coordinate along the track; none empty.
  Placement(std::vector<std::vector<double>> points, const PlacementOptions& options);

  // By track, in order, if they are known before there are records; they must outlive this. The first wave of a budget
  // then leaves no stretch between those whose jumps are not known without a record, if that takes no more than two
  // thirds of it.
  void SetEvents(std::vector<std::span<const VisibilityEvent>> events) { events_ = std::move(events); }

  // By track.
  void SetCorners(std::vector<TrackCorners> corners) { corners_ = std::move(corners); }

  // The next wave; empty when the records do. Sets the errors of all records. They may have been there before, of
  // whatever placement; on tracks that have none a first wave comes first.
  std::vector<RecordPlace> Next(std::vector<CacheRecord>& records) const;
  // Sets footprints, when no wave is left: they cover every point.
  void SetFootprints(std::vector<CacheRecord>& records) const;

 private:
  // The first wave on those that have no records, of `most` that are left to be made.
  std::vector<RecordPlace> First(const std::vector<std::uint32_t>& tracks, std::size_t most) const;
  std::vector<double> FirstOf(std::uint32_t track, std::size_t count) const;
  // Parts of the points between events.
  std::vector<Gap> Stretches(std::uint32_t track) const;
  void ClampNeighbours(const std::vector<CacheRecord*>& track, double extent) const;
  // By track, in order.
  std::vector<std::vector<CacheRecord*>> Sorted(std::vector<CacheRecord>& records) const;
  double Extent(std::size_t track) const { return points_[track].back() - points_[track].front(); }

  std::vector<std::vector<double>> points_;
  std::vector<std::span<const VisibilityEvent>> events_;
  std::vector<TrackCorners> corners_;
  PlacementOptions options_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_PLACEMENT_H_
