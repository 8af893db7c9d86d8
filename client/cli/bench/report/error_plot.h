// SPDX-License-Identifier: Apache-2.0
// Error against time as a picture: a panel for each scene and quantity, a line for each method, both axes logarithmic.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_REPORT_ERROR_PLOT_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_REPORT_ERROR_PLOT_H_

#include <string>
#include <vector>

#include "client/cli/bench/analysis/curve.h"
#include "client/cli/formats/plot_style.h"

namespace flatlight {

// The program for gnuplot 5.4. Points have bars of two standard errors; the line is the fit. A method that shows no
// error is a vertical line at its time. Deterministic.
std::string ErrorPlotScript(const std::vector<Curve>& curves, PlotForm form);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_REPORT_ERROR_PLOT_H_
