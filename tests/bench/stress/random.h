// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_RANDOM_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_RANDOM_H_

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "core/math/trig.h"
#include "core/math/vec.h"

namespace flatlight::stress {

// Random numbers that are the same on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double Next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  // In [0, 1).
  double Uniform(double low, double high) { return low + (high - low) * Next(); }
  std::uint64_t Below(std::uint64_t n) { return engine_() % n; }
  int Int(int low, int high) { return low + static_cast<int>(Below(static_cast<std::uint64_t>(high - low + 1))); }
  bool Chance(double p) { return Next() < p; }
  double Sign() { return Chance(0.5) ? 1 : -1; }
  // Of every size between two powers of ten.
  double Size(int low_exponent, int high_exponent) {
    double value = Uniform(1, 10);
    const int exponent = Int(low_exponent, high_exponent - 1);
    for (int i = 0; i < exponent; ++i) value *= 10;
    for (int i = 0; i > exponent; --i) value /= 10;
    return value;
  }
  double Angle() { return Uniform(-std::numbers::pi, std::numbers::pi); }
  Vector2 Direction() {
    const SinCosValue turn = SinCos(Angle());
    return {turn.cos, turn.sin};
  }
  Point2 Point() {
    const double x = Uniform(-1, 1);
    return {x, Uniform(-1, 1)};
  }
  // On a grid of that step, in [-1, 1]^2. The step must divide 1.
  Point2 GridPoint(double step) {
    const int n = static_cast<int>(1 / step);
    const double x = step * Int(-n, n);
    return {x, step * Int(-n, n)};
  }

 private:
  std::mt19937_64 engine_;
};

// Well mixed seeds from small numbers (the finaliser of SplitMix64, Steele et al. 2014).
inline std::uint64_t Mixed(std::uint64_t seed, std::uint64_t number) {
  std::uint64_t x = seed * 0x9e3779b97f4a7c15u + number + 1;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_RANDOM_H_
