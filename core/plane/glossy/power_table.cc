// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/power_table.h"

#include <algorithm>
#include <cmath>

#include "core/math/power.h"

namespace flatlight {
namespace {

// Of a power, and of a number.
constexpr double kNothing = 1e-19;
constexpr double kSmallest = 0x1p-40;
constexpr int kMantissa = 52;
// Of the relative distance from a place n times as much is at most kReach, for 0.25^11/11! is below rounding; and the
// distance itself at most 2^-5, whose 11th power is.
constexpr double kReach = 0.25;
constexpr int kLeastBits = 4;

}  // namespace

PowerTable::PowerTable(double exponent) : least_(std::max(UnitPower(kNothing, 1 / exponent), kSmallest)) {
  int bits = kLeastBits;
  while (bits < kMantissa && exponent > kReach * std::ldexp(1.0, bits + 1)) ++bits;
  shift_ = kMantissa - bits;
  const auto place_of = [&](double x) { return std::bit_cast<std::uint64_t>(x) >> shift_; };
  first_ = place_of(least_);
  for (std::uint64_t i = first_; i <= place_of(1); ++i) {
    const auto low = std::bit_cast<double>(i << shift_);
    const double middle = std::min(std::bit_cast<double>((2 * i + 1) << (shift_ - 1)), 1.0);
    places_.push_back({1 / (low < 1 ? middle : 1), low < 1 ? UnitPower(middle, exponent) : 1});
  }
  double term = 1;
  for (std::size_t k = 0; k < kTerms; ++k) {
    series_[k] = term;
    term *= (exponent - static_cast<double>(k)) / static_cast<double>(k + 1);
  }
}

}  // namespace flatlight
