// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_STATISTICS_SHARED_MISSES_H_
#define FLATLIGHT_CORE_STATISTICS_SHARED_MISSES_H_

#include <cmath>
#include <optional>

#include "core/statistics/replicates.h"

namespace flatlight {

// Whether none of some values, whose squared distances from their mean add up to `squares`, has met an event that
// changes one by `event` while others have not. One that has met it makes the sum (1 - 1/n) times its square.
inline bool Agree(double squares, double event) { return squares < 0.25 * event * event; }

// The root mean square error of n values that agree, where a share d of all values meets an event that changes one by
// `largest`, and all d are alike likely (Laplace's rule of succession).
inline double MostMissed(double largest, double n) { return largest * std::sqrt(2 / ((n + 2) * (n + 3))); }

// What values that agree may be off by together, as many points tell: those of which one half of the values agrees. The
// other half knows nothing of that, so the square of how far its mean is off, less its variance, has the squared error
// of the first as its expectation. What the first half's own spread tells of it is taken off.
// (All values agree less often than half of them, and are off by less then: errors come out somewhat too large.)
class SharedMisses {
 public:
  // The values of a point, of which each tells of the same mean; `event` as of Agree. `ratio`: the variance of a half's
  // mean over what its spread tells.
  void Add(const HalvesSpread& values, double event, double ratio = 1);
  // The points of another one.
  void Add(const SharedMisses& other);
  // Whether halves that met an event which the other one did not are higher for it on the whole, as they are where
  // events bring light.
  bool any() const { return offs_ > 0; }
  // The mean square, beyond the variance of the mean, of all points where values agree; `step`: by how much an event
  // changes the mean of half of a point's values. It is told by points that meet an event twice, and is noisy where few
  // do; but it is no less than if events were as frequent everywhere: of k events at n points, and all frequencies
  // alike likely, that would be (k + 1)(k + 2)/n^2 (Laplace). Absent if no values agree.
  std::optional<double> MeanSquare(double step) const;

 private:
  double points_ = 0;              // Where values agree: halves count half.
  double squares_ = 0, offs_ = 0;  // What the other halves tell.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_SHARED_MISSES_H_
