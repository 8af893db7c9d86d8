// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/measurement/measurement.h"

#include <algorithm>
#include <cmath>

#include "client/cli/bench/measurement/sketch.h"
#include "client/cli/comparison/matching.h"
#include "client/cli/formats/enum_names.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

using Array = google::protobuf::RepeatedField<double>;

// Of |value| and the probe's mean: two ways to sum the same terms. Standard errors below are rounding, no chance.
constexpr double kRounding = 1e-12;

const Array& ValuesOf(const v1::ProbeResult& probe, BenchQuantity quantity) {
  if (quantity == BenchQuantity::kGradient) return probe.gradient();
  return quantity == BenchQuantity::kHessian ? probe.hessian() : probe.irradiance();
}

const Array& ErrorsOf(const v1::ProbeResult& probe, BenchQuantity quantity) {
  if (quantity == BenchQuantity::kGradient) return probe.gradient_error();
  return quantity == BenchQuantity::kHessian ? probe.hessian_error() : probe.standard_error();
}

// The stated standard error of a value; 0 if the probe is deterministic.
double DeviationOf(const v1::ProbeResult& probe, BenchQuantity quantity, int i) {
  const Array& errors = ErrorsOf(probe, quantity);
  return probe.standard_error().empty() || errors.empty() ? 0 : errors[i];
}

bool HaveAll(const v1::RenderResult& result, BenchQuantity quantity) {
  return std::all_of(result.probes().begin(), result.probes().end(), [quantity](const v1::ProbeResult& probe) {
    return probe.count() == 0 || !ValuesOf(probe, quantity).empty();
  });
}

double MeanSize(const Array& values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value) / values.size();
  return sum;
}

std::optional<QuantityError> ErrorOf(const v1::RenderResult& result, const v1::RenderResult& truth,
                                     BenchQuantity quantity) {
  if (!HaveAll(result, quantity) || !HaveAll(truth, quantity)) return std::nullopt;
  QuantityError error;
  Sketch sketch;
  double square = 0, truth_square = 0, truth_variance = 0, z = 0, z2 = 0;
  int values = 0, estimated = 0;
  for (const v1::ProbeResult& true_probe : truth.probes()) {
    const v1::ProbeResult& probe = *FindProbe(result, true_probe.name());
    const Array& is = ValuesOf(probe, quantity);
    const Array& should = ValuesOf(true_probe, quantity);
    const double rounding = kRounding * MeanSize(should);
    for (int i = 0; i < should.size(); ++i) {
      const double off = is[i] - should[i];
      const double own = DeviationOf(probe, quantity, i), truths = DeviationOf(true_probe, quantity, i);
      square += off * off;
      truth_square += should[i] * should[i];
      truth_variance += truths * truths;
      error.largest = std::max(error.largest, std::abs(off));
      sketch.Add(off);
      ++values;
      if (own <= rounding + kRounding * std::abs(should[i])) continue;
      const double deviation = std::hypot(own, truths);
      z += off / deviation;
      z2 += off * off / (deviation * deviation);
      ++estimated;
    }
  }
  if (values == 0) return std::nullopt;
  error.rms = std::sqrt(square / values);
  error.truth_rms = std::sqrt(truth_variance / values);
  if (square > 0) error.relative = truth_square > 0 ? std::sqrt(square / truth_square) : 1;
  error.sketch = sketch.Projections();
  if (estimated > 0) {
    error.mean_z = z / estimated;
    error.mean_z2 = z2 / estimated;
  }
  return error;
}

}  // namespace

absl::Status Measure(const v1::RenderResult& result, const v1::RenderResult& truth, BenchRow& row) {
  const std::string mismatch = FindMismatch(result, truth);
  if (!mismatch.empty()) return UsageError("the truth does not fit the scene: " + mismatch);
  row.wall_seconds = result.statistics().wall_seconds();
  row.cpu_seconds = result.statistics().cpu_seconds();
  row.rays = result.statistics().rays();
  row.end_reason = OptionName(result.end_reason());
  for (const BenchQuantity quantity : kBenchQuantities)
    row.errors[static_cast<std::size_t>(quantity)] = ErrorOf(result, truth, quantity);
  return absl::OkStatus();
}

}  // namespace flatlight
