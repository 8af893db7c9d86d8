// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMPARISON_MATCHING_H_
#define FLATLIGHT_CLIENT_CLI_COMPARISON_MATCHING_H_

#include <string>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

// Empty if both results have the same probes: names in any order, channels, and points (where both give positions, to
// 1e-9 of their extent). Else what is different.
std::string FindMismatch(const v1::RenderResult& a, const v1::RenderResult& b);

// Null if there is none of that name.
const v1::ProbeResult* FindProbe(const v1::RenderResult& result, const std::string& name);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMPARISON_MATCHING_H_
