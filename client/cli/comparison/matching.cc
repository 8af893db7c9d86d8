// SPDX-License-Identifier: Apache-2.0
#include "client/cli/comparison/matching.h"

#include <algorithm>
#include <cmath>

#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

constexpr double kSamePlace = 1e-9;

using Array = google::protobuf::RepeatedField<double>;

std::string FindMovedPoint(const Array& a, const Array& b) {
  if (a.empty() || a.size() != b.size()) return "";
  const auto [low, high] = std::minmax_element(a.begin(), a.end());
  const double extent = std::max({*high - *low, std::abs(*high), std::abs(*low)});
  for (int i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > kSamePlace * extent)
      return "point " + std::to_string(i / 2) + " is elsewhere: positions[" + std::to_string(i) + "] is " +
             FormatValue(a[i], 9) + " and " + FormatValue(b[i], 9);
  return "";
}

std::string FindProbeMismatch(const v1::ProbeResult& a, const v1::ProbeResult& b) {
  const auto both = [](unsigned x, unsigned y) { return std::to_string(x) + " and " + std::to_string(y); };
  if (a.quantity() != b.quantity() && a.quantity() != 0 && b.quantity() != 0) return "quantities differ";
  if (a.count() != b.count()) return both(a.count(), b.count()) + " points";
  if (a.channels() != b.channels()) return both(a.channels(), b.channels()) + " channels";
  return FindMovedPoint(a.positions(), b.positions());
}

}  // namespace

const v1::ProbeResult* FindProbe(const v1::RenderResult& result, const std::string& name) {
  for (const v1::ProbeResult& probe : result.probes())
    if (probe.name() == name) return &probe;
  return nullptr;
}

std::string FindMismatch(const v1::RenderResult& a, const v1::RenderResult& b) {
  for (const v1::ProbeResult& probe : b.probes())
    if (FindProbe(a, probe.name()) == nullptr) return "probe '" + probe.name() + "' is in B only";
  for (const v1::ProbeResult& probe : a.probes()) {
    const v1::ProbeResult* other = FindProbe(b, probe.name());
    if (other == nullptr) return "probe '" + probe.name() + "' is in A only";
    const std::string mismatch = FindProbeMismatch(probe, *other);
    if (!mismatch.empty()) return "probe '" + probe.name() + "': " + mismatch;
  }
  return "";
}

}  // namespace flatlight
