// SPDX-License-Identifier: Apache-2.0
// The errors of all points, small enough for a cell of a table: random projections, from which the RMS of sums and
// means over runs can be estimated later, without the runs. N. Alon, Y. Matias, M. Szegedy, "The space complexity of
// approximating the frequency moments", 1996.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_MEASUREMENT_SKETCH_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_MEASUREMENT_SKETCH_H_

#include <cstdint>
#include <optional>
#include <vector>

namespace flatlight {

// Adds up sign(k, i) error_i for k < kProjections; each divided by sqrt(number of values) it has mean square RMS^2 over
// the choices of the signs, which are fixed: sketches of runs of one scene can be added.
class Sketch {
 public:
  static constexpr int kProjections = 32;

  void Add(double error);
  std::vector<double> Projections() const;

 private:
  std::vector<double> sums_ = std::vector<double>(kProjections);
  std::uint64_t count_ = 0;
};

// What runs with different seeds have in common, from their sketches.
struct BiasEstimate {
  double rms = 0;          // RMS over the points of the error of the mean over the runs; a factor sqrt(2/32) unsure.
  double noise_rms = 0;    // What unbiased runs that scatter as these do, and the truth's own error, would show.
  double probability = 1;  // Of a ratio of both so large, or larger, without bias.
};

// Absent for fewer than 2 runs, or if some have no sketch. `truth_rms` is the standard error of the truth, which all
// runs have in common.
std::optional<BiasEstimate> EstimateBias(const std::vector<std::vector<double>>& sketches, double truth_rms);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_MEASUREMENT_SKETCH_H_
