// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/plot_style.h"

#include "client/cli/text/text_table.h"

namespace flatlight {

// Enhanced text has its own special characters. An apostrophe becomes a typographic one: gnuplot's own way, to double
// it, fails at the beginning of a text.
std::string PlotText(const std::string& text) {
  std::string quoted = "'";
  for (const char c : CutToWidth(Printable(text), 60)) {
    if (std::string("{}^_@&~\\").find(c) != std::string::npos) quoted += '\\';
    quoted += c == '\'' ? "\u2019" : std::string(1, c);
  }
  return quoted + "'";
}

std::string PlotTerminal(PlotForm form, int width, int height) {
  const auto size = [=](int scale) { return std::to_string(width * scale) + "," + std::to_string(height * scale); };
  if (form == PlotForm::kSvg)
    return "set terminal svg size " + size(1) +
           " dynamic enhanced background 'white' font 'Helvetica,Arial,sans-serif,13'\n";
  return "set terminal pngcairo size " + size(2) + " enhanced background 'white' font 'DejaVu Sans,11' fontscale 2 " +
         "linewidth 2 pointscale 2\n";
}

}  // namespace flatlight
