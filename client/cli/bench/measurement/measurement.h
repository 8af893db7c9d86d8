// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_MEASUREMENT_MEASUREMENT_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_MEASUREMENT_MEASUREMENT_H_

#include "absl/status/status.h"
#include "client/cli/bench/rows/bench_row.h"
#include "flatlight/v1/result.pb.h"

namespace flatlight {

// How far a result is from the truth, over all probes together: the quantities that both have. The row's own words
// (scene, repeat, ...) are left as they are in `row`; times, rays, errors are set. Bad usage if the probes are others.
absl::Status Measure(const v1::RenderResult& result, const v1::RenderResult& truth, BenchRow& row);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_MEASUREMENT_MEASUREMENT_H_
