// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_FINDINGS_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_FINDINGS_H_

#include <string>
#include <vector>

#include "client/cli/bench/analysis/curve.h"

namespace flatlight {

// What a reader of the tables should not overlook, a sentence each: bias beyond noise, stated errors that are too
// small, errors that fall slower than 1 / sqrt(time). All tests of all curves together cry wolf less than once in 100
// times.
std::vector<std::string> FindingsOf(const std::vector<Curve>& curves);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_ANALYSIS_FINDINGS_H_
