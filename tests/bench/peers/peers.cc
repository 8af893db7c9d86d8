// SPDX-License-Identifier: Apache-2.0
// Flatlight beside other libraries, in one run on one thread: ./run bench peers. See docs/benchmarks.md.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/bench/peers/exact_contest.h"
#include "tests/bench/peers/ray_contest.h"
#include "tests/bench/peers/report.h"

namespace flatlight {
namespace {

struct Options {
  std::vector<int> ray_sizes = {10, 1000, 100'000};
  std::vector<int> light_sizes = {100, 1000, 10'000};
  std::vector<double> lengths;
  std::string only;
  std::string csv = "-";
  ContestOptions contest;
};

void Declare(CLI::App& app, Options& options) {
  app.add_option("--ray-sizes", options.ray_sizes, "Numbers of segments to cast rays at")
      ->check(CLI::Range(1, 10'000'000))
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--light-sizes", options.light_sizes, "Numbers of segments to compute exact light among")
      ->check(CLI::Range(1, 1'000'000))
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--lengths", options.lengths,
                 "Lengths of the n segments, times 1/sqrt(n); default: 0.5, 1, 0.1, and 0.05 for any n")
      ->check(CLI::Range(1e-6, 10.0))
      ->delimiter(',');
  app.add_option("--only", options.only, "One of the two comparisons")->check(CLI::IsMember({"rays", "light"}));
  app.add_option("--emitting", options.contest.emitting, "Share of the segments that shine")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--rounds", options.contest.turns.rounds, "Turns that each program gets at each case")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  app.add_option("--slice", options.contest.turns.slice, "Seconds a turn, on average over the programs")
      ->check(CLI::Range(1e-4, 10.0))
      ->capture_default_str();
  app.add_flag("!--check", options.contest.timing, "Only check that the programs agree; measure nothing");
  app.add_option("--csv", options.csv, "File for the CSV; - is standard output")->capture_default_str();
}

int Main(int argc, char** argv) {
  CLI::App app("Flatlight beside Box2D, Embree and CGAL: rates as CSV, and a table on standard error.", "peers");
  Options options;
  Declare(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  options.contest.lengths.assign(kLengthRules.begin(), kLengthRules.end());
  if (!options.lengths.empty()) options.contest.lengths.clear();
  for (const double factor : options.lengths) options.contest.lengths.push_back({factor, true});
  std::FILE* file = options.csv == "-" ? stdout : std::fopen(options.csv.c_str(), "w");
  if (!file) {
    std::perror(("peers: " + options.csv).c_str());
    return 2;
  }

  std::vector<Row> rows;
  bool agree = true;
  if (options.only != "light") {
    ContestOptions contest = options.contest;
    contest.sizes = options.ray_sizes;
    agree = RunRayContest(contest, rows) && agree;
  }
  if (options.only != "rays") {
    ContestOptions contest = options.contest;
    contest.sizes = options.light_sizes;
    agree = RunExactContest(contest, rows) && agree;
  }
  const bool written = WriteCsv(rows, file);
  if (options.contest.timing) PrintTable(rows, stderr);
  if (!written) std::fprintf(stderr, "peers: %s: could not be written\n", options.csv.c_str());
  if (!agree) std::fprintf(stderr, "peers: the programs disagree; see above. The figures above do not count.\n");
  return agree && written ? 0 : 1;
}

}  // namespace
}  // namespace flatlight

int main(int argc, char** argv) { return flatlight::Main(argc, argv); }
