// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/moment_sum.h"

namespace flatlight {
namespace {

// k/(k + 1), of the polynomials' recurrence.
constexpr std::array<double, kResidualCoefficients> kQuotients = [] {
  std::array<double, kResidualCoefficients> quotients{};
  for (std::size_t k = 0; k < quotients.size(); ++k) quotients[k] = static_cast<double>(k) / static_cast<double>(k + 1);
  return quotients;
}();

}  // namespace

const double* MomentSum::Finish() {
  if (waiting_ > 0) Flush();
  return sum_.data();
}

void MomentSum::Flush() {
  for (; waiting_ < kTogether; ++waiting_) weight_[waiting_] = 0;
  waiting_ = 0;
  // The polynomials times the weights, of two degrees.
  std::array<double, kTogether> before = weight_, p;
  for (std::size_t j = 0; j < kTogether; ++j) p[j] = x_[j] * weight_[j];
  sum_[0] += (before[0] + before[1]) + (before[2] + before[3]);
  for (std::size_t k = 1;; ++k) {
    sum_[k] += (p[0] + p[1]) + (p[2] + p[3]);
    if (k + 1 == count_) return;
    const double q = kQuotients[k], r = 1 + q;
    for (std::size_t j = 0; j < kTogether; ++j) {
      const double next = r * x_[j] * p[j] - q * before[j];
      before[j] = p[j], p[j] = next;
    }
  }
}

}  // namespace flatlight
