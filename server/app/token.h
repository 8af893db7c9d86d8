// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_APP_TOKEN_H_
#define FLATLIGHT_SERVER_APP_TOKEN_H_

#include <string>

#include "absl/status/statusor.h"

namespace flatlight {

// The first line of a file. An error if it cannot be read or is empty.
absl::StatusOr<std::string> ReadTokenFile(const std::string& path);

// The environment's FLATLIGHT_TOKEN, which is then removed, so that it is not seen in /proc by later programs. Empty if
// there is none.
std::string TakeTokenFromEnvironment();

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_APP_TOKEN_H_
