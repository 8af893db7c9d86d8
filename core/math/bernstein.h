// SPDX-License-Identifier: Apache-2.0
// Polynomials of degree 8 on [0, 1] by their Bernstein coefficients: between the smallest and the largest of these lie
// all values, and there are at most as many roots as the coefficients change their sign, of the same parity.
#ifndef FLATLIGHT_CORE_MATH_BERNSTEIN_H_
#define FLATLIGHT_CORE_MATH_BERNSTEIN_H_

#include <array>
#include <cstddef>

namespace flatlight {

struct Bernstein {
  static constexpr std::size_t kCount = 9;

  std::array<double, kCount> b{};

  // Where Through() wants values: Chebyshev's points.
  static const std::array<double, kCount>& Nodes();
  // The polynomial with these values at Nodes().
  static Bernstein Through(const std::array<double, kCount>& values);

  double At(double t) const;
  double Min() const;
  double Max() const;

  // All roots in [0, 1) in their order, to 1e-10 or so, but pairs that are closer than 1e-12; at most kCount - 1.
  struct RootList {
    std::array<double, kCount> t{};
    std::size_t count = 0;
  };
  RootList Roots() const;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_MATH_BERNSTEIN_H_
