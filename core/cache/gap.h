// SPDX-License-Identifier: Apache-2.0
// A stretch of a track between two neighbouring records, or a record and the end of the wanted points: how wrong
// extrapolation is there, and where more records help most.
#ifndef FLATLIGHT_CORE_CACHE_GAP_H_
#define FLATLIGHT_CORE_CACHE_GAP_H_

#include <cstddef>
#include <span>
#include <vector>

#include "core/cache/record.h"

namespace flatlight {

// At which of its ends a track meets a curve in a corner, where both reflect: irradiance there goes like x log x, whose
// derivatives grow without limit.
struct TrackCorners {
  bool low = false, high = false;
};

// A record vouches for what lies beside it, over events whose jumps are known, up to the next one where they are not;
// beyond there is a stretch of its own.
struct Gap {
  static constexpr double kFarOff = 1e50;  // Of errors: as good as infinite, and its square is none.

  const CacheRecord* before = nullptr;  // Whose footprint reaches in from the left,
  const CacheRecord* after = nullptr;   // and from the right; null if none does.
  double low = 0, high = 0;
  std::span<const double> points;  // Wanted in it, in order.
  // The largest estimate at these points: of both records together where they are joined (RecordPair), with what that
  // leaves of the jumps between, else by the better of the nearest records.
  double error = 0;
  double squares = 0;  // Sum of the squares of these.
  // Records put in will be joined with each other and with those at hand.
  bool joins = false;
  TrackCorners corners;  // That the gap ends at.

  // The estimate when `count` records are put in.
  double ErrorWith(std::size_t count, std::size_t power) const;
  // At which of the points these are best put, in order; never where a record is.
  std::vector<double> Places(std::size_t count, std::size_t power) const;

 private:
  // Of the records at hand: half-footprints that reach into the gap.
  std::size_t Halves() const { return (before ? 1u : 0u) + (after ? 1u : 0u); }
  double JoinedErrorWith(std::size_t count, std::size_t power) const;
  // Where in the gap, in [0, 1], the record of a number is best put if the light is alike everywhere.
  double ShareOf(std::size_t number, std::size_t count) const;
};

// The gaps of a track with its records in order. `points`: in order, not empty.
std::vector<Gap> FindGaps(std::span<const double> points, std::span<const CacheRecord* const> records,
                          const TrackCorners& corners);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_GAP_H_
