// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/startup_watch.h"

#include <ctime>
#include <fstream>
#include <string>

namespace flatlight {
namespace {

constexpr std::chrono::seconds kTellAfter{3};

}  // namespace

ProcessActivity ReadActivity(pid_t process) {
  ProcessActivity activity;
  clockid_t clock{};
  timespec cpu{};
  if (clock_getcpuclockid(process, &clock) == 0 && clock_gettime(clock, &cpu) == 0) {
    activity.cpu = std::chrono::seconds(cpu.tv_sec) + std::chrono::nanoseconds(cpu.tv_nsec);
  }
  // "PID (NAME) STATE …", where NAME may hold anything.
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');
  if (name_end != std::string::npos && name_end + 2 < line.size()) {
    const char state = line[name_end + 2];
    activity.wants_to_run = state == 'R' || state == 'D';
  }
  return activity;
}

StartupWatch::Verdict StartupWatch::Look(Time now, const ProcessActivity& activity) {
  if (activity.wants_to_run || activity.cpu > cpu_) last_progress_ = now;
  cpu_ = activity.cpu;
  if (now - start_ >= kPatience) return Verdict::kTooLong;
  return now - last_progress_ >= kIdlePatience ? Verdict::kIdle : Verdict::kGoesOn;
}

bool StartupWatch::WorthTelling(Time now) {
  if (told_ || now - start_ < kTellAfter) return false;
  told_ = true;
  return true;
}

}  // namespace flatlight
