// SPDX-License-Identifier: Apache-2.0
#include "client/cli/comparison/comparison.h"

#include <algorithm>
#include <cmath>

#include "client/cli/comparison/matching.h"
#include "client/cli/formats/result_columns.h"
#include "client/cli/statistics/distributions.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

using Array = google::protobuf::RepeatedField<double>;

constexpr double kFailureRate = 1e-4;  // Of a comparison of results that estimate the same, over all its tests.
constexpr double kRounding = 1e-12;    // Of |value| and the probe's mean: two ways to sum the same terms.
constexpr double kDark = 0.01;         // Of the probe's mean: relative errors don't look below.

// mean z^2 of n honest z's is above kHonest * (1 + kSpread / sqrt(n)) less than once in 10^4 times, for n >= kFewest:
// the variance of z^2 is 2 + 6 / (14 - 4) for Student's t of 14 degrees of freedom scaled to variance 1, and 8 of its
// standard deviations cover the long tail (found by simulation: 3e-5 for n = 16, 3e-6 for n = 64). kHonest is the
// variance of t itself: results of others may state the plain standard error.
constexpr double kHonest = 14.0 / 12.0;
const double kSpread = 8 * std::sqrt(2.6);
constexpr int kFewest = 16;

struct Values {
  const Array* value;
  const Array* error;  // Standard errors or bounds; may be empty.
};

Values Get(const v1::ProbeResult& probe, const std::string& quantity) {
  if (quantity == "gradient") return {&probe.gradient(), &probe.gradient_error()};
  if (quantity == "rotation") return {&probe.rotation_gradient(), &probe.rotation_gradient_error()};
  if (quantity == "hessian") return {&probe.hessian(), &probe.hessian_error()};
  return {&probe.irradiance(), &probe.standard_error()};
}

// One side's stated error of a value: a standard error if the probe is estimated, else a bound; or the bias that it
// expects beside the first.
struct Stated {
  double deviation = 0;
  double bound = 0;
};

Stated ErrorOf(const v1::RenderResult& result, const v1::ProbeResult& probe, const Values& values, int i,
               bool irradiance) {
  const bool estimated = !probe.standard_error().empty();
  if (estimated) {
    const double bias = irradiance && !probe.estimated_bias().empty() ? probe.estimated_bias(i) : 0;
    return {values.error->empty() ? 0 : (*values.error)[i], bias};
  }
  if (irradiance && !probe.irradiance_error().empty()) return {0, probe.irradiance_error(i)};
  if (irradiance && !probe.estimated_error().empty()) return {0, probe.estimated_error(i)};
  if (irradiance) return {0, result.statistics().error_bound()};
  return {0, values.error->empty() ? 0 : (*values.error)[i]};
}

// The entries of flat arrays that belong to points of which both results know something.
std::vector<int> KnownEntries(const v1::ProbeResult& a, const v1::ProbeResult& b) {
  const int channels = static_cast<int>(a.channels());
  std::vector<int> entries;
  for (int point = 0; point < static_cast<int>(a.count()); ++point) {
    if (!IsKnown(a, point) || !IsKnown(b, point)) continue;
    for (int channel = 0; channel < channels; ++channel) entries.push_back(point * channels + channel);
  }
  return entries;
}

double MeanSize(const Array& values, const std::vector<int>& entries) {
  double sum = 0;
  for (const int i : entries) sum += std::abs(values[i]) / static_cast<double>(entries.size());
  return sum;
}

class QuantityComparer {
 public:
  QuantityComparer(const v1::RenderResult& a, const v1::RenderResult& b, const std::string& quantity)
      : result_a_(a), result_b_(b), quantity_(quantity) {}

  // `point_limit` and `mean_limit` are in standard errors; not used with a tolerance.
  QuantityComparison Run(const v1::ProbeResult& a, const v1::ProbeResult& b, std::optional<double> tolerance,
                         double point_limit, double mean_limit) {
    const Values va = Get(a, quantity_), vb = Get(b, quantity_);
    QuantityComparison out;
    out.probe = a.name();
    out.quantity = quantity_;
    const std::vector<int> entries = KnownEntries(a, b);
    out.values = static_cast<int>(entries.size());
    const double mean_size = MeanSize(*vb.value, entries);
    double square = 0, reference = 0, sum_z = 0, sum_z2 = 0, worst = 1;
    int estimated = 0;
    for (const int i : entries) {
      const double x = (*va.value)[i], y = (*vb.value)[i], difference = x - y;
      const Stated ea = ErrorOf(result_a_, a, va, i, quantity_ == "irradiance");
      const Stated eb = ErrorOf(result_b_, b, vb, i, quantity_ == "irradiance");
      const double deviation = std::hypot(ea.deviation, eb.deviation);
      const double rounding = kRounding * (std::max(std::abs(x), std::abs(y)) + mean_size);
      square += difference * difference / out.values;
      reference += y * y / out.values;
      if (std::abs(difference) > out.largest) {
        out.largest = std::abs(difference);
        out.largest_index = i;
      }
      if (deviation > rounding) {
        ++estimated;
        // Beyond what is stated of bias and bounds.
        const double beyond = std::max(std::abs(difference) - ea.bound - eb.bound, 0.0);
        sum_z += std::copysign(beyond, difference) / deviation;
        sum_z2 += beyond * beyond / (deviation * deviation);
      }
      const double allowed = tolerance ? *tolerance * std::max(std::abs(y), kDark * mean_size)
                                       : point_limit * deviation + ea.bound + eb.bound + rounding;
      const double excess = std::abs(difference) / allowed;  // NaN if both are 0, which is no excess.
      if (excess > worst) {
        worst = excess;
        out.difference = quantity_ + "[" + std::to_string(i) + "] is " + FormatValue(x, 9) + ", not " +
                         FormatValue(y, 9) + ": off by " + FormatValue(std::abs(difference)) + ", allowed " +
                         FormatValue(allowed);
      }
    }
    out.rms = std::sqrt(square);
    if (reference > 0) out.relative_rms = out.rms / std::sqrt(reference);
    if (estimated > 0) {
      out.mean_z = sum_z / estimated;
      out.mean_z2 = sum_z2 / estimated;
    }
    if (!tolerance && estimated > 0 && out.difference.empty())
      out.difference = JudgeMeans(out, estimated / static_cast<double>(a.channels()), mean_limit);
    return out;
  }

 private:
  // The channels of a point share their paths, so only points count as independent.
  static std::string JudgeMeans(const QuantityComparison& c, double points, double mean_limit) {
    const double z_limit = mean_limit / std::sqrt(points);
    if (std::abs(*c.mean_z) > z_limit)
      return "mean z of " + c.quantity + " is " + FormatValue(*c.mean_z, 3) + ", allowed within " +
             FormatValue(z_limit, 3) + ": one of them is biased";
    const double z2_limit = kHonest * (1 + kSpread / std::sqrt(points));
    if (points >= kFewest && *c.mean_z2 > z2_limit)
      return "mean z^2 of " + c.quantity + " is " + FormatValue(*c.mean_z2, 3) + ", allowed up to " +
             FormatValue(z2_limit, 3) + ": the differences are larger than the stated errors";
    return "";
  }

  const v1::RenderResult& result_a_;
  const v1::RenderResult& result_b_;
  const std::string quantity_;
};

bool Has(const v1::ProbeResult& probe, const std::string& quantity) { return !Get(probe, quantity).value->empty(); }

}  // namespace

bool Comparison::Equal() const {
  return std::all_of(quantities.begin(), quantities.end(),
                     [](const QuantityComparison& c) { return c.difference.empty(); });
}

absl::StatusOr<Comparison> Compare(const v1::RenderResult& a, const v1::RenderResult& b,
                                   std::optional<double> tolerance) {
  const std::string mismatch = FindMismatch(a, b);
  if (!mismatch.empty()) return UsageError("the results cannot be compared: " + mismatch);
  struct Pair {
    const v1::ProbeResult* a;
    const v1::ProbeResult* b;
    std::string quantity;
  };
  std::vector<Pair> pairs;
  double values = 0;
  for (const v1::ProbeResult& probe : a.probes()) {
    const v1::ProbeResult* other = FindProbe(b, probe.name());
    if (probe.count() > 0 && KnownEntries(probe, *other).empty()) {
      return UsageError("the results cannot be compared: probe '" + probe.name() +
                        "' has no point with samples in both");
    }
    for (const char* quantity : {"irradiance", "gradient", "rotation", "hessian"})
      if (Has(probe, quantity) && Has(*other, quantity)) {
        pairs.push_back({&probe, other, quantity});
        values += Get(probe, quantity).value->size();
      }
  }
  if (pairs.empty()) return UsageError("the results cannot be compared: they have no points");
  // Half of the failure rate for the points, half for the two means of each quantity; Bonferroni within.
  const double point_limit = StudentQuantile(0.5 * kFailureRate / values, kDegreesOfFreedom);
  const double mean_limit =
      StudentQuantile(0.5 * kFailureRate / (2 * static_cast<double>(pairs.size())), kDegreesOfFreedom);
  Comparison comparison;
  comparison.worlds_differ = !a.world_hash().empty() && !b.world_hash().empty() && a.world_hash() != b.world_hash();
  for (const Pair& pair : pairs)
    comparison.quantities.push_back(
        QuantityComparer(a, b, pair.quantity).Run(*pair.a, *pair.b, tolerance, point_limit, mean_limit));
  return comparison;
}

}  // namespace flatlight
