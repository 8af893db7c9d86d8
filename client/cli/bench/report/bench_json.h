// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_REPORT_BENCH_JSON_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_REPORT_BENCH_JSON_H_

#include <string>
#include <vector>

#include "client/cli/bench/analysis/curve.h"
#include "client/cli/bench/versus/versus.h"

namespace flatlight {

// The same as BenchText and VersusText, for programs. Figures that there are not are absent.
std::string BenchJson(const std::vector<Curve>& curves, const std::vector<BenchRow>& rows);
std::string VersusJson(const Versus& versus);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_REPORT_BENCH_JSON_H_
