// SPDX-License-Identifier: Apache-2.0
// What the writers of results rely on: arrays of the length that count and channels demand, and no NaN or infinity.
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_RESULT_SHAPE_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_RESULT_SHAPE_H_

#include <string>

#include "flatlight/v1/result.pb.h"

namespace flatlight {

// Empty if all is well, else what is wrong with the first bad field: "probes[1].irradiance[17] is nan".
std::string FindResultDefect(const v1::RenderResult& result);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_RESULT_SHAPE_H_
