// SPDX-License-Identifier: Apache-2.0
// Exact direct light a second: Flatlight's irradiance with both derivatives and error bounds, and CGAL's visible
// polygon, from which light would yet have to be computed.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_EXACT_CONTEST_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_EXACT_CONTEST_H_

#include <vector>

#include "tests/bench/peers/contest.h"
#include "tests/bench/peers/report.h"

namespace flatlight {

// Adds rows. False, with messages on standard error, if irradiance differs, or if there is no room for so many segments
// that do not cross.
bool RunExactContest(const ContestOptions& options, std::vector<Row>& rows);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_EXACT_CONTEST_H_
