// SPDX-License-Identifier: Apache-2.0
// One benchmark against another: B over A.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_VERSUS_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_VERSUS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/bench/versus/point_versus.h"

namespace flatlight {

struct PointVersus {
  std::string scene;
  std::string method;
  std::optional<std::uint32_t> budget;
  BenchQuantity quantity = BenchQuantity::kIrradiance;
  int runs_a = 0;
  int runs_b = 0;
  std::optional<Ratio> time, error, efficiency;
  Change verdict = Change::kNotSeen;
  // Too noisy: runs (seeds, if it is the error) that each of A and B would need; absent if that cannot be told.
  std::optional<int> runs_needed;
};

struct Versus {
  std::vector<PointVersus> points;
  PointVersus overall;             // Geometric means over the points; no scene, method or budget.
  std::vector<std::string> notes;  // What was left out, and why.

  int Count(Change verdict) const;
  // Of a point, or overall.
  bool SomethingIsWorse() const;
};

struct VersusOptions {
  double failure_rate = 0.01;  // That two benchmarks of the same get any better or worse.
  double least = 0.05;         // The smallest relative change that counts.
};

// Points are joined by scene, method, settings, truth and budget. Of a file that has rows of several machines or builds
// those count that are as its last row is. Bad usage if there is nothing to compare.
absl::StatusOr<Versus> CompareBenches(const std::vector<BenchRow>& a, const std::vector<BenchRow>& b,
                                      const VersusOptions& options);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_VERSUS_VERSUS_H_
