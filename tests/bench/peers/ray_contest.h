// SPDX-License-Identifier: Apache-2.0
// Closest hits a second: Flatlight, Box2D, Embree.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_RAY_CONTEST_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_RAY_CONTEST_H_

#include <vector>

#include "tests/bench/peers/contest.h"
#include "tests/bench/peers/report.h"

namespace flatlight {

// Adds rows. False, with messages on standard error, if the programs disagree by more than single precision explains.
bool RunRayContest(const ContestOptions& options, std::vector<Row>& rows);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_RAY_CONTEST_H_
