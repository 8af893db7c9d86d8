// SPDX-License-Identifier: Apache-2.0
#include "server/service/build_version.h"

namespace flatlight {

std::string BuildVersion() { return FLATLIGHT_VERSION; }

}  // namespace flatlight
