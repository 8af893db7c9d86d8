// SPDX-License-Identifier: Apache-2.0
// Error of one result against another.
#ifndef FLATLIGHT_CLIENT_CLI_COMPARISON_COMPARISON_H_
#define FLATLIGHT_CLIENT_CLI_COMPARISON_COMPARISON_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "flatlight/v1/result.pb.h"

namespace flatlight {

// Degrees of freedom of a standard error: it comes from two halves of 8 independently randomised replicates.
inline constexpr int kDegreesOfFreedom = 14;

// Of one quantity ("irradiance", "gradient", "rotation", "hessian") of one probe.
struct QuantityComparison {
  std::string probe;
  std::string quantity;
  int values = 0;  // Points that both know times channels.
  double rms = 0;  // Of A - B; in the unit of the quantity, as is `largest`.
  double largest = 0;
  int largest_index = 0;               // In the array.
  std::optional<double> relative_rms;  // rms over that of B; absent if B is 0 everywhere.
  std::optional<double> mean_z;        // Of (A - B) / standard error, where there is one; absent if nowhere.
  std::optional<double> mean_z2;
  std::string difference;  // Why the verdict is that they differ; empty if they agree.
};

struct Comparison {
  std::vector<QuantityComparison> quantities;
  bool worlds_differ = false;  // By their hashes, if both have one.
  bool Equal() const;
};

// The rule is in `flatlight compare --help` (help_texts.h). INVALID_ARGUMENT if the probes do not match, or one has no
// point that both know.
absl::StatusOr<Comparison> Compare(const v1::RenderResult& a, const v1::RenderResult& b,
                                   std::optional<double> tolerance);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMPARISON_COMPARISON_H_
