// SPDX-License-Identifier: Apache-2.0
// What all plots have in common.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_STYLE_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_STYLE_H_

#include <array>
#include <string>

namespace flatlight {

enum class PlotForm { kSvg, kPng };

// Told apart also by colour-blind people: M. Okabe, K. Ito, "Color universal design", 2008.
inline constexpr std::array<const char*, 7> kPlotColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                            "#E69F00", "#56B4E9", "#000000"};

// User text inside single quotes, as gnuplot 5.4 wants it; cut to 60 columns.
std::string PlotText(const std::string& text);

// The command that begins a script. Width and height in pixels (PNG: twice that).
std::string PlotTerminal(PlotForm form, int width, int height);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_PLOT_STYLE_H_
