// SPDX-License-Identifier: Apache-2.0
// The options of `bench` and of `bench compare`, besides those of a render.
#ifndef FLATLIGHT_CLIENT_CLI_OPTIONS_BENCH_OPTIONS_H_
#define FLATLIGHT_CLIENT_CLI_OPTIONS_BENCH_OPTIONS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace flatlight {

struct BenchOptions {
  std::vector<std::string> scenes;  // SCENE as written.
  bool gallery = false;
  std::vector<std::string> methods;    // Names; empty: all that the server has.
  std::vector<std::uint32_t> budgets;  // Samples, growing; empty: the default ladder.
  std::uint32_t seeds = 16;
  std::uint32_t repeats = 1;         // Of each seed.
  std::optional<double> time_limit;  // s, of all runs together.
  std::vector<std::string> truths;   // Files.
  std::optional<std::uint32_t> truth_samples;
  bool force = false;
  double least = 0.05;  // Of `bench compare`.
};

// As written on the command line.
struct BenchTexts {
  std::vector<std::string> scenes, truths;
  std::optional<std::string> methods, budgets, seeds, repeats, time_limit, truth_samples, least;
  bool gallery = false;
  bool force = false;
};

// Values out of range end with ExitCode::kUsage: "--budgets: '16,x'; must be ...".
absl::StatusOr<BenchOptions> ParseBenchOptions(const BenchTexts& texts);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OPTIONS_BENCH_OPTIONS_H_
