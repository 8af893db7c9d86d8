// SPDX-License-Identifier: Apache-2.0
// What a campaign measures on its way: how differences compare with the bounds that are stated for them.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_TALLY_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_TALLY_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

namespace flatlight::stress {

// Non-negative ratios, in bins of a power of two.
class Ratios {
 public:
  void Add(double ratio) {
    ++count_;
    if (ratio > largest_) largest_ = ratio;
    ++bins_[Bin(ratio)];
  }
  std::uint64_t count() const { return count_; }
  double largest() const { return largest_; }
  // The upper end of the bin in which the share of all ratios lies at or below.
  double Quantile(double share) const {
    const double wanted = share * static_cast<double>(count_);
    double below = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      below += static_cast<double>(bins_[bin]);
      if (below >= wanted) return bin == 0 ? 0 : std::min(std::ldexp(1.0, static_cast<int>(bin) - kShift), largest_);
    }
    return largest_;
  }

 private:
  static constexpr std::size_t kBins = 96;
  static constexpr int kShift = 64;
  // Bin 0 holds 0 and what is next to it.
  static std::size_t Bin(double ratio) {
    if (!(ratio > 0)) return 0;
    int exponent = 0;
    std::frexp(ratio, &exponent);
    return static_cast<std::size_t>(std::clamp(exponent + kShift, 0, static_cast<int>(kBins) - 1));
  }

  std::uint64_t count_ = 0;
  double largest_ = 0;
  std::array<std::uint64_t, kBins> bins_{};
};

// z = (estimate - truth) / stated error.
struct Deviations {
  double count = 0;
  double sum = 0;
  double sum_of_squares = 0;
  double largest = 0;

  void Add(double z) {
    ++count, sum += z, sum_of_squares += z * z;
    largest = std::max(largest, std::abs(z));
  }
  double Mean() const { return count > 0 ? sum / count : 0; }
  double MeanSquare() const { return count > 0 ? sum_of_squares / count : 0; }
};

// A term of every scene, whose mean is 0 if all is right however it is spread: what is too small to be seen in one
// scene adds up over many.
class Pooled {
 public:
  void Add(double term) { ++scenes_, sum_ += term, squares_ += term * term; }
  double scenes() const { return scenes_; }
  double sum() const { return sum_; }
  double squares() const { return squares_; }
  // The sum over its own scatter: nearly a standard normal number if all is right and scenes are many, as the terms of
  // different scenes are independent.
  double Score() const { return squares_ > 0 ? sum_ / std::sqrt(squares_) : 0; }
  // Whether the score is beyond chance: a normal number is above kMostScore once in 5e7. That leaves a campaign that
  // judges 60 such sums at its end a false alarm in 1e5, with a margin for terms that are far from normal.
  bool IsAbove() const { return scenes_ >= kLeastScenes && Score() > kMostScore; }
  bool IsBelow() const { return scenes_ >= kLeastScenes && Score() < -kMostScore; }

 private:
  static constexpr double kLeastScenes = 1000;
  static constexpr double kMostScore = 5.5;

  double scenes_ = 0;
  double sum_ = 0;
  double squares_ = 0;
};

struct Tally {
  std::map<std::string, Ratios> ratios;
  std::map<std::string, Deviations> deviations;
  std::map<std::string, Pooled> biases;    // Of estimates: none may be above or below.
  std::map<std::string, Pooled> excesses;  // Of squared errors over what is stated: none may be above.
  std::map<std::string, std::uint64_t> counts;

  // |difference| against a bound: within it, or not. Neither may be NaN.
  bool Within(const std::string& what, double difference, double bound) {
    const double size = std::abs(difference);
    ratios[what].Add(size == 0 ? 0 : size / bound);
    return size <= bound;
  }
};

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_TALLY_H_
