// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_BUILD_VERSION_H_
#define FLATLIGHT_SERVER_SERVICE_BUILD_VERSION_H_

#include <string>

namespace flatlight {

// The release and the commit it was built from, for instance "0.1.0+1bcd874a90e2"; the release alone outside a git
// checkout. Results name it, and job keys contain it: two builds may differ in the last bit.
std::string BuildVersion();

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_BUILD_VERSION_H_
