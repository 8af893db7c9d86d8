// SPDX-License-Identifier: Apache-2.0
// One run of a benchmark: what was rendered, on what, how long it took, and how far it was from the truth.
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_ROWS_BENCH_ROW_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_ROWS_BENCH_ROW_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flatlight {

enum class BenchQuantity : std::uint8_t { kIrradiance, kGradient, kHessian };
inline constexpr std::array<BenchQuantity, 3> kBenchQuantities = {BenchQuantity::kIrradiance, BenchQuantity::kGradient,
                                                                  BenchQuantity::kHessian};
// "irradiance", "gradient", "hessian".
const char* NameOf(BenchQuantity quantity);

// Error of one quantity over all points and channels of a scene; W/m, W/m^2 or W/m^3.
struct QuantityError {
  double rms = 0;                // Of estimate - truth.
  double largest = 0;            // Of |estimate - truth|.
  double relative = 0;           // rms over the RMS of the truth; 1 if only that is 0.
  std::optional<double> mean_z;  // Of z = (estimate - truth) / stated standard error; absent if nothing is stated.
  std::optional<double> mean_z2;
  double truth_rms = 0;  // The truth's own error, RMS: part of `rms`.
  // Random projections of the errors of all points (sketch.h): from them, errors of means over runs follow.
  std::vector<double> sketch;

  // rms without the truth's own part: 0 if that is all there is.
  double OwnRms() const;
  double OwnRelative() const;
};

struct BenchRow {
  std::string scene;       // As the user named it.
  std::string scene_hash;  // Of world and probes.
  std::string method;      // "path-tracing".
  std::string settings;    // As options, every default filled in; without method, samples, seed and threads.
  std::string truth;       // What errors are against: "exact", "path-tracing 1000000", "file 0123456789ab".
  std::optional<std::uint32_t> budget;  // Samples; absent if the method draws none.
  std::optional<std::uint32_t> seed;
  std::uint32_t repeat = 0;  // Of the same run: 0, 1, ...
  double wall_seconds = 0;   // As the server states them.
  double cpu_seconds = 0;
  double rays = 0;
  std::string end_reason;  // "samples-done".
  std::array<std::optional<QuantityError>, kBenchQuantities.size()> errors;
  std::uint32_t threads = 0;
  std::string processor;  // The server's.
  std::uint32_t processors = 0;
  std::string client;  // Builds.
  std::string server;
  std::string date;  // When the run ended: UTC, "2026-01-31T12:00:00Z".

  const std::optional<QuantityError>& ErrorOf(BenchQuantity quantity) const {
    return errors[static_cast<std::size_t>(quantity)];
  }
};

// Rows of one point were to give the same error but for chance: same scene, method, settings, truth and budget.
bool SamePoint(const BenchRow& a, const BenchRow& b);

// The same run of the same point: same seed and repeat, too.
bool SameRun(const BenchRow& a, const BenchRow& b);

// Empty if times of both rows can be compared, and both belong in one file: same machine and builds. Else the first
// thing that differs: "the server's build is 0.1.0+a, not 0.1.0+b".
std::string OtherContext(const BenchRow& is, const BenchRow& wanted);

// "AMD EPYC, 8 processors, 4 threads".
std::string MachineOf(const BenchRow& row);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_ROWS_BENCH_ROW_H_
