// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_CACHE_INTERPOLATION_H_
#define FLATLIGHT_CORE_CACHE_INTERPOLATION_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "core/cache/error_control.h"
#include "core/cache/record.h"
#include "core/cache/record_pair.h"

namespace flatlight {

struct Interpolated {
  Spectrum irradiance;
  double error = 0;         // Estimated, of the channel that has most.
  std::size_t records = 0;  // That took part.
};

enum class Weighting : bool {
  kDistance,  // 1 - distance/radius (Jarosz et al. 2012; THEORY 8).
  // The same over the estimated error: where that is an odd power of the distance, as from the second degree on, the
  // errors of a record to the left and one to the right have different signs, and such weights let them cancel.
  kError
};

Weighting WeightingOf(ErrorControl control);

// What the two records beside a place tell together, where they are joined (RecordPair); else the mean of what the
// records of one track whose footprints cover it extrapolate to.
class TrackInterpolation {
 public:
  // `records`: of one track.
  TrackInterpolation(std::vector<const CacheRecord*> records, std::size_t degree, Weighting weighting);

  Interpolated At(double place) const;

 private:
  std::vector<const CacheRecord*> records_;       // In order.
  std::vector<std::optional<RecordPair>> pairs_;  // Of each and the next one.
  std::vector<double> reach_;                     // How far those up to it reach to the right.
  double left_reach_ = 0;                         // The largest radius to the left.
  std::size_t degree_;
  Weighting weighting_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_INTERPOLATION_H_
