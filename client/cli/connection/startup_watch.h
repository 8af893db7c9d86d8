// SPDX-License-Identifier: Apache-2.0
// Whether a program that is starting still gets on.
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_STARTUP_WATCH_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_STARTUP_WATCH_H_

#include <sys/types.h>

#include <chrono>

namespace flatlight {

// What the system tells of a process.
struct ProcessActivity {
  std::chrono::nanoseconds cpu{0};  // Processor time so far, of all threads.
  bool wants_to_run = false;        // Runs, or waits for a processor or for the disk.
};

// Of a child that has not been waited for.
ProcessActivity ReadActivity(pid_t process);

// A busy machine may let a program start as slowly as it likes; one that does nothing any more will not come.
class StartupWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kIdlePatience{10};
  static constexpr std::chrono::minutes kPatience{10};  // Also with one that works and works.

  explicit StartupWatch(Time start) : start_(start), last_progress_(start) {}

  enum class Verdict { kGoesOn, kIdle, kTooLong };
  Verdict Look(Time now, const ProcessActivity& activity);

  // True once, when it has taken so long that a person will want to know why nothing happens.
  bool WorthTelling(Time now);

 private:
  Time start_;
  Time last_progress_;
  std::chrono::nanoseconds cpu_{0};
  bool told_ = false;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_STARTUP_WATCH_H_
