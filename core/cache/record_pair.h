// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_CACHE_RECORD_PAIR_H_
#define FLATLIGHT_CORE_CACHE_RECORD_PAIR_H_

#include <array>
#include <cstddef>
#include <vector>

#include "core/cache/record.h"

namespace flatlight {

// What two neighbouring records tell together of the irradiance between them: the polynomial that has the values and
// derivatives of both (two-point Hermite interpolation). Its error, that of f^(2n) with n known values at each end, is
// far below that of either record's Taylor polynomial. What jumps at events between is known, so it is taken off the
// right record, the smooth rest is joined, and the jumps are put back beyond each event.
class RecordPair {
 public:
  // Whether they are such, left to right, all jumps between are known, and their errors are those of a series (see
  // SetErrors).
  static bool Joins(const CacheRecord& left, const CacheRecord& right);

  // Both must outlive this; Joins(left, right). Derivatives up to `degree` < known count.
  RecordPair(const CacheRecord& left, const CacheRecord& right, std::size_t degree);

  // Places are those between the records.
  Spectrum At(double place) const;
  // Estimated by what the next two derivatives change, at either end, and no less than what it is seen to be off at
  // events; absolute.
  double ErrorAt(double place) const;
  // That, relative to what counts (CacheRecord::CostAt).
  double CostAt(double place) const;
  // The share of the left record's value.
  double LeftShare(double place) const;

 private:
  // An event between, and how many of its jumps are taken off.
  struct Jump {
    const VisibilityEvent* event;
    std::size_t orders;
  };
  // Where it is known to be off by more than expected.
  struct Doubt {
    double at, off;
  };

  double Fraction(double place) const { return (place - left_.at) / width_; }
  // Takes jumps off the right record and estimates what that leaves.
  void Smooth();
  double SmoothErrorAt(double fraction) const;
  // Of the smooth rest, with so many derivatives.
  Spectrum Polynomial(std::size_t degree, double fraction) const;

  const CacheRecord& left_;
  const CacheRecord& right_;
  std::size_t degree_;
  double width_;
  std::vector<Jump> jumps_;                           // In order.
  std::array<Spectrum, kRecordOrders> smooth_right_;  // The right record's derivatives without them.
  // Derivative degree + 1 + k changes the polynomial at fraction t by at most change_[k] (t (1 - t))^(degree + 1 + k).
  std::array<double, 2> change_{};
  std::size_t changes_ = 0;  // That are known.
  std::vector<Doubt> doubts_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_CACHE_RECORD_PAIR_H_
