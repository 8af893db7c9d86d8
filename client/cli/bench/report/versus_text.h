// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_BENCH_REPORT_VERSUS_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_BENCH_REPORT_VERSUS_TEXT_H_

#include <string>

#include "client/cli/bench/versus/versus.h"

namespace flatlight {

// "better", "worse", "no difference seen", "too noisy to tell".
const char* ChangeText(Change change);

std::string VersusText(const Versus& versus, const VersusOptions& options);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_BENCH_REPORT_VERSUS_TEXT_H_
