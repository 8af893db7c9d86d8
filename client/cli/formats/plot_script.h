// SPDX-License-Identifier: Apache-2.0
// A result as a picture for people: irradiance over arc length with a band of two standard errors, and the derivatives
// below it, each probe (and channel) a line. This writes the program for gnuplot 5.4; gnuplot.h runs it.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_SCRIPT_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_SCRIPT_H_

#include <string>

#include "client/cli/formats/plot_style.h"
#include "flatlight/v1/result.pb.h"

namespace flatlight {

// Deterministic. Probes without arc length make the axis the number of the point. Lines of more than some thousand
// points are thinned so that peaks stay.
std::string PlotScript(const v1::RenderResult& result, PlotForm form);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_SCRIPT_H_
