// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_FORMATS_TIMESTAMP_H_
#define FLATLIGHT_CLIENT_CLI_FORMATS_TIMESTAMP_H_

#include <chrono>

#include "google/protobuf/timestamp.pb.h"

namespace flatlight {

// In s since 1970.
inline double SecondsOf(const google::protobuf::Timestamp& time) {
  return static_cast<double>(time.seconds()) + 1e-9 * time.nanos();
}

inline double SecondsNow() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_FORMATS_TIMESTAMP_H_
