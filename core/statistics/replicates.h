// SPDX-License-Identifier: Apache-2.0
// Estimates from randomised replicates. Samples within a replicate are correlated (they are stratified); the means of
// replicates are not, unless those of each half share a sequence (see halves_ratio.h), and they alone tell the error.
#ifndef FLATLIGHT_CORE_STATISTICS_REPLICATES_H_
#define FLATLIGHT_CORE_STATISTICS_REPLICATES_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

namespace flatlight {

inline constexpr std::size_t kReplicates = 16;
inline constexpr std::size_t kHalfReplicates = kReplicates / 2;

// Relative. Values are sums over a path and a tree of blocks, each step correct to 2^-53: of the order of 32 steps
// count.
inline constexpr double kReplicateRounding = 32 * 0x1p-53;

// A mean and the variance of that mean, as estimated from `degrees_of_freedom` + 1 values.
struct MeanEstimate {
  double mean = 0;
  double variance = 0;
  double degrees_of_freedom = 1;
  double unresolved = 0;  // Standard error of what all values may have missed alike, added in quadrature.
  double rounding = 0;    // Of the arithmetic behind the values, beyond that of sums.

  // (mean - truth) / standard error has variance 1: the t distribution of nu degrees of freedom, which the plain ratio
  // follows if the values are normal, has variance nu / (nu - 2). Never below the rounding.
  double StandardError() const;

  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.mean, self.variance, self.degrees_of_freedom, self.unresolved, self.rounding);
  }
};

// Some values: how many, their mean, and the sum of squared distances from it.
struct Spread {
  double count = 0;
  double mean = 0;
  double squares = 0;

  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.count, self.mean, self.squares);
  }
};
Spread SpreadOf(std::span<const double> values);

// An even number of values as two halves: all that errors are told by.
struct HalvesSpread {
  Spread first, second;

  Spread All() const;

  template <class Self, class Stream>
  static void State(Self& self, Stream& stream) {
    stream(self.first, self.second);
  }
};
HalvesSpread HalvesSpreadOf(std::span<const double> values);

// An event that values may all have missed: a sample that falls to the other side of an edge, or on something bright.
struct Missable {
  double seen = 0;     // By how much one that was met nearby would change a value.
  double largest = 0;  // The most that there may be.
  // Nearby there are 1 / share^2 times as many samples as behind the values: what none of them met is so much rarer.
  double share = 1;
  // Of the mean, if events are as frequent as nearby.
  double variance = std::numeric_limits<double>::infinity();

  // What values that agree have not met.
  double Event() const { return std::max(seen, share * largest); }
};

// Variances of replicates' values at a point's neighbours. A variance that is told by few replicates is a noisy thing,
// and low just where rare bright paths were missed; so a point's own counts by its `share`, that of its neighbours
// makes up the rest.
struct NearbyVariance {
  double mean = 0;   // Of single values.
  double share = 1;  // 1: the point's own alone.
  // Mean square of what values that agree are off by together (SharedMisses); absent if nothing is known of it.
  std::optional<double> missed = {};
};

// Tells from pairs of independent variances, of one point each, how far points differ: what the two have in common is
// the point's, the rest is noise. The best linear guess at a point's true variance is then mean + share * (own - mean),
// whatever their distribution.
class NearbyVariances {
 public:
  void Add(double a, double b) {
    ++count_;
    sum_a_ += a, sum_b_ += b;
    products_ += a * b;
    differences_ += (a - b) * (a - b);
  }
  // Of few points nothing is known.
  NearbyVariance Result() const;

 private:
  double count_ = 0, sum_a_ = 0, sum_b_ = 0, products_ = 0, differences_ = 0;
};

// Stratified samples place an edge to within one sample, and rare events are missed, so values may all agree and all be
// wrong. Let a share d of such values have met the event, all d alike likely: if none of n has, the mean square of d is
// 2/((n + 2)(n + 3)) (Laplace's rule of succession), and the doubt that follows is added: that of the largest event,
// less where samples nearby tell of rarer or smaller ones, or what alike points tell of those whose values agree. If
// some values have met it, their spread tells.
MeanEstimate EstimateMean(const Spread& spread, const Missable& missable, const NearbyVariance& nearby = {});
inline MeanEstimate EstimateMean(std::span<const double> values, const Missable& missable,
                                 const NearbyVariance& nearby = {}) {
  return EstimateMean(SpreadOf(values), missable, nearby);
}

// The same, where nothing is known from nearby of an event that changes a value by `step`.
inline MeanEstimate EstimateMean(std::span<const double> values, double step) {
  return EstimateMean(values, Missable{step, step});
}

// The plain average of two independent estimates. Its degrees of freedom are those of Welch (1947).
MeanEstimate Average(const MeanEstimate& a, const MeanEstimate& b);

// standard_error / max(mean, floor); 0 if both are 0, infinite if only the latter is.
double RelativeError(double mean, double standard_error, double floor);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_STATISTICS_REPLICATES_H_
