// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_TELEMETRY_PROCESS_READINGS_H_
#define FLATLIGHT_SERVER_TELEMETRY_PROCESS_READINGS_H_

namespace flatlight {

// What the system says of this process.
struct ProcessReadings {
  double cpu_seconds = 0;     // Of all threads, since it started.
  double resident_bytes = 0;  // 0 where the system does not tell, as below.
  double heap_bytes = 0;      // That were allocated and not freed: without what the C library keeps for later.
  double open_files = 0;
};

ProcessReadings ReadProcess();

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_TELEMETRY_PROCESS_READINGS_H_
