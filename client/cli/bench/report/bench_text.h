// SPDX-License-Identifier: Apache-2.0
// What a benchmark found, as tables for people.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_REPORT_BENCH_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_REPORT_BENCH_TEXT_H_

#include <string>
#include <vector>

#include "client/cli/bench/analysis/curve.h"
#include "client/cli/bench/analysis/time_to.h"

namespace flatlight {

// Points, curves, findings, and how to read them. `rows` is what the curves were made of, of one machine.
std::string BenchText(const std::vector<Curve>& curves, const std::vector<BenchRow>& rows);

// "-0.50 +- 0.01": the slope with its interval of 95 %; "-" without a fit.
std::string SlopeText(const std::optional<PowerFit>& fit);

// "0.35 s"; "< 0.1 ms" where the fastest point is better already; "~ 3:20" by the fit; "-".
std::string TimeToText(const TimeTo& time);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_REPORT_BENCH_TEXT_H_
