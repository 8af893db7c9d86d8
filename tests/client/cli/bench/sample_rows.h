// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_CLIENT_CLI_BENCH_SAMPLE_ROWS_H_
#define FLATLIGHT_TESTS_CLIENT_CLI_BENCH_SAMPLE_ROWS_H_

#include <string>
#include <vector>

#include "client/cli/bench/rows/bench_row.h"

namespace flatlight {

// A run of path tracing; RMS error = relative error, as if the RMS of the truth were 1.
inline BenchRow SampleRow(const std::string& scene, std::uint32_t budget, std::uint32_t seed, double seconds,
                          double error) {
  BenchRow row;
  row.scene = scene;
  row.scene_hash = "hash of " + scene;
  row.method = "path-tracing";
  row.settings = "--max-bounces 0 --derivatives none";
  row.truth = "exact";
  row.budget = budget;
  row.seed = seed;
  row.cpu_seconds = seconds;
  row.wall_seconds = seconds / 2;
  row.rays = 1000.0 * budget;
  row.end_reason = "samples-done";
  row.errors[0] = QuantityError{error, 3 * error, error, 0.01, 0.9, 0, {}};
  row.threads = 2;
  row.processor = "a processor, \"quoted\"";
  row.processors = 4;
  row.client = "1+a";
  row.server = "1+b";
  row.date = "2026-01-31T12:00:00Z";
  return row;
}

// A run of a method without budget, seed and error.
inline BenchRow ExactRow(const std::string& scene, std::uint32_t repeat, double seconds) {
  BenchRow row = SampleRow(scene, 1, 1, seconds, 0);
  row.method = "exact";
  row.budget.reset();
  row.seed.reset();
  row.repeat = repeat;
  row.errors[0] = QuantityError{};
  row.errors[1] = QuantityError{};
  return row;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CLIENT_CLI_BENCH_SAMPLE_ROWS_H_
