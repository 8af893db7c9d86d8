// SPDX-License-Identifier: Apache-2.0
// The machine that the server runs on: times mean little without it.
#ifndef FLATLIGHT_SERVER_SERVICE_MACHINE_H_
#define FLATLIGHT_SERVER_SERVICE_MACHINE_H_

#include <cstdint>
#include <string>

namespace flatlight {

// Empty if the system does not tell. Read once: the file takes the system long to make.
const std::string& ProcessorModel();

// That this process may use.
std::uint32_t UsableProcessors();

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_MACHINE_H_
