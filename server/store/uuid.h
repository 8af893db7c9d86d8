// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_UUID_H_
#define FLATLIGHT_SERVER_STORE_UUID_H_

#include <string>
#include <string_view>

namespace flatlight {

// RFC 4122, version 4: 36 characters, lower case.
std::string RandomUuid();
bool IsUuid(std::string_view text);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_UUID_H_
