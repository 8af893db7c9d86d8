// SPDX-License-Identifier: Apache-2.0
#include "server/telemetry/process_readings.h"

#include <malloc.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace flatlight {

ProcessReadings ReadProcess() {
  ProcessReadings readings;
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  readings.cpu_seconds = static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec);
  double pages = 0;
  double resident = 0;
  if (std::ifstream statm("/proc/self/statm"); statm >> pages >> resident) {
    readings.resident_bytes = resident * static_cast<double>(sysconf(_SC_PAGESIZE));
  }
#ifdef __GLIBC__
  const struct mallinfo2 heap = mallinfo2();
  readings.heap_bytes = static_cast<double>(heap.uordblks + heap.hblkhd);
#endif
  std::error_code error;
  const std::filesystem::directory_iterator files("/proc/self/fd", error);
  if (!error) readings.open_files = static_cast<double>(std::distance(begin(files), end(files)));
  return readings;
}

}  // namespace flatlight
