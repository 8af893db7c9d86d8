// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/rows/bench_row.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

std::string Other(const std::string& what, const std::string& is, const std::string& wanted) {
  return is == wanted ? "" : what + " is " + (is.empty() ? "unknown" : is) + ", not " + wanted;
}

}  // namespace

const char* NameOf(BenchQuantity quantity) {
  switch (quantity) {
    case BenchQuantity::kGradient:
      return "gradient";
    case BenchQuantity::kHessian:
      return "hessian";
    default:
      return "irradiance";
  }
}

double QuantityError::OwnRms() const { return std::sqrt(std::max(0.0, rms * rms - truth_rms * truth_rms)); }

double QuantityError::OwnRelative() const { return rms > 0 ? relative * (OwnRms() / rms) : 0; }

bool SamePoint(const BenchRow& a, const BenchRow& b) {
  return std::tie(a.scene_hash, a.method, a.settings, a.truth, a.budget) ==
         std::tie(b.scene_hash, b.method, b.settings, b.truth, b.budget);
}

bool SameRun(const BenchRow& a, const BenchRow& b) {
  return SamePoint(a, b) && a.seed == b.seed && a.repeat == b.repeat;
}

std::string MachineOf(const BenchRow& row) {
  return (row.processor.empty() ? "unknown processor" : row.processor) + ", " + Plural(row.processors, "processor") +
         ", " + Plural(row.threads, "thread");
}

std::string OtherContext(const BenchRow& is, const BenchRow& wanted) {
  for (const std::string& other :
       {Other("the machine", MachineOf(is), MachineOf(wanted)), Other("the server's build", is.server, wanted.server),
        Other("the client's build", is.client, wanted.client)})
    if (!other.empty()) return other;
  return "";
}

}  // namespace flatlight
