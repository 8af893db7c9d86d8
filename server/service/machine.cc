// SPDX-License-Identifier: Apache-2.0
#include "server/service/machine.h"

#include <sched.h>

#include <fstream>
#include <thread>

namespace flatlight {

namespace {

std::string ReadProcessorModel() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

}  // namespace

const std::string& ProcessorModel() {
  static const std::string kModel = ReadProcessorModel();
  return kModel;
}

std::uint32_t UsableProcessors() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<std::uint32_t>(CPU_COUNT(&set));
  return std::thread::hardware_concurrency();
}

}  // namespace flatlight
