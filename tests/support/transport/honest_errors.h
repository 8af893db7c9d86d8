// SPDX-License-Identifier: Apache-2.0
// Do stated errors tell the truth? For independent estimates, z = (estimate - truth) / stated error must have mean 0
// and mean square 1.
#ifndef FLATLIGHT_TESTS_SUPPORT_TRANSPORT_HONEST_ERRORS_H_
#define FLATLIGHT_TESTS_SUPPORT_TRANSPORT_HONEST_ERRORS_H_

#include <cmath>
#include <cstddef>

namespace flatlight {

class HonestErrors {
 public:
  void Add(double estimate, double truth, double stated_error) {
    const double z = (estimate - truth) / stated_error;
    ++count_;
    sum_ += z;
    sum_of_squares_ += z * z;
  }

  std::size_t count() const { return count_; }
  double MeanZ() const { return sum_ / static_cast<double>(count_); }
  double MeanSquareZ() const { return sum_of_squares_ / static_cast<double>(count_); }

  // Both within 5 standard deviations: failure rate 6e-7 each, as both are means of hundreds of values. z scaled to
  // variance 1 follows t_15, whose kurtosis is 3 + 6 / (15 - 4): so z^2 has variance 2 + 6/11.
  static constexpr double kDeviations = 5;
  bool Unbiased() const { return std::abs(MeanZ()) < kDeviations / std::sqrt(static_cast<double>(count_)); }
  bool RightSize() const {
    return std::abs(MeanSquareZ() - 1) < kDeviations * std::sqrt((2 + 6.0 / 11) / static_cast<double>(count_));
  }

 private:
  std::size_t count_ = 0;
  double sum_ = 0;
  double sum_of_squares_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_SUPPORT_TRANSPORT_HONEST_ERRORS_H_
