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

// Up to the next event a record vouches for what lies beside it; beyond there is a stretch of its own.
struct Gap {
  const CacheRecord* before = nullptr;  // Whose footprint reaches in from the left,
  const CacheRecord* after = nullptr;   // and from the right; null if none does.
  double low = 0, high = 0;
  std::span<const double> points;  // Wanted in it, in order.
  double error = 0;                // The largest estimate at these points, by the better of the nearest records.

  // The estimate when `count` records are put in.
  double ErrorWith(std::size_t count, std::size_t power) const;
  // At which of the points these are best put, in order; never where a record is.
  std::vector<double> Places(std::size_t count, std::size_t power) const;

 private:
  // Of the records at hand: half-footprints that reach into the gap.
  std::size_t Halves() const { return (before ? 1u : 0u) + (after ? 1u : 0u); }
};

// The gaps of a track with its records in order. `points`: in order, not empty.
std::vector<Gap> FindGaps(std::span<const double> points, std::span<const CacheRecord* const> records);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_GAP_H_
