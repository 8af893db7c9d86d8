// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/report.h"

#include <map>
#include <span>

#include "tests/bench/peers/machine.h"

namespace flatlight {
namespace {

// As RFC 4180 quotes.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

template <typename... Arguments>
std::string Text(const char* format, Arguments... arguments) {
  char text[128];
  std::snprintf(text, sizeof(text), format, arguments...);
  return text;
}

std::string Scaled(double rate) { return rate >= 1e6 ? Text("%.2f M", 1e-6 * rate) : Text("%.2f k", 1e-3 * rate); }

}  // namespace

bool WriteCsv(const std::vector<Row>& rows, std::FILE* file) {
  const Machine machine = ThisMachine();
  std::fprintf(file,
               "name,scene,size,density,unit,rate,flatlight_ratio,flatlight_ratio_q1,flatlight_ratio_q3,differing,"
               "machine,vector_unit,compiler,build,date\n");
  const std::string where = Quoted(machine.processor) + "," + machine.vector_unit + "," + Quoted(machine.compiler) +
                            "," + machine.build + "," + machine.date;
  for (const Row& row : rows) {
    const Timing& timing = row.timing;
    const std::string figures =
        timing.rate > 0 ? Text("%.6g,%.4g,%.4g,%.4g", timing.rate, timing.ratio, timing.ratio_q1, timing.ratio_q3)
                        : ",,,";
    std::fprintf(file, "%s,%s,%d,%s,%s,%s,%.3g,%s\n", row.name.c_str(), row.scene.c_str(), row.size,
                 row.density.c_str(), row.unit.c_str(), figures.c_str(), row.differing, where.c_str());
  }
  return std::fflush(file) == 0 && std::ferror(file) == 0;
}

void PrintTable(const std::vector<Row>& rows, std::FILE* file) {
  std::string header;
  std::map<std::string, const Row*> worst;  // Where Flatlight is ahead least, by peer.
  // Flatlight's row comes first in each case.
  for (std::size_t i = 0, end; i < rows.size(); i = end) {
    const Row& ours = rows[i];
    for (end = i + 1; end < rows.size() && rows[end].name != ours.name;) ++end;
    std::string names, ratios;
    for (const Row& row : std::span(rows).subspan(i + 1, end - i - 1)) {
      const Timing& timing = row.timing;
      names += Text("  %-22s", row.name.c_str());
      ratios += Text("%6.2f (%.2f to %.2f)", timing.ratio, timing.ratio_q1, timing.ratio_q3);
      ratios.resize(names.size(), ' ');
      if (row.name.rfind(ours.name, 0) == 0) continue;  // Flatlight in another way.
      const Row*& least = worst.emplace(row.name, &row).first->second;
      if (timing.ratio < least->timing.ratio) least = &row;
    }
    if (names != header) {
      std::fprintf(file, "\nHow many times the rate of each peer is Flatlight's: median (quartiles)\n");
      std::fprintf(file, "%-34s %6s  %-11s %16s%s\n", "scene", "size", "length", "flatlight", names.c_str());
    }
    header = names;
    std::fprintf(file, "%-34s %6d  %-11s %7s %-8s%s\n", ours.scene.c_str(), ours.size, ours.density.c_str(),
                 Scaled(ours.timing.rate).c_str(), ours.unit.c_str(), ratios.c_str());
  }
  std::fprintf(file, "\n");
  for (const auto& [name, row] : worst) {
    std::fprintf(file, "least against %-20s %6.2f  (%s, %d segments of %s)\n", name.c_str(), row->timing.ratio,
                 row->scene.c_str(), row->size, row->density.c_str());
  }
}

}  // namespace flatlight
