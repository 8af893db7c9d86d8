// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_POWER_TABLE_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_POWER_TABLE_H_

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flatlight {

// x^n for one n > 0 and x in (0, 1], to some n ulp: powers of as many places as make (x/place)^n a short series. The
// same bits on every machine.
class PowerTable {
 public:
  explicit PowerTable(double exponent);

  // x: above least(), at most 1.
  double Power(double x) const {
    const std::uint64_t place = (std::bit_cast<std::uint64_t>(x) >> shift_) - first_;
    const Place& near = places_[place];
    const double d = x * near.inverse - 1;
    double sum = 0;
    for (std::size_t k = kTerms; k-- > 0;) sum = sum * d + series_[k];
    return near.power * sum;
  }
  // Powers of what is less are nothing beside rounding, or the table would be too large: see UnitPower.
  double least() const { return least_; }

 private:
  static constexpr std::size_t kTerms = 11;
  struct Place {
    double inverse = 1, power = 1;
  };

  int shift_;  // Bits of a number that its place leaves out.
  double least_;
  std::uint64_t first_;
  std::array<double, kTerms> series_{};  // (1 + d)^n
  std::vector<Place> places_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_POWER_TABLE_H_
