// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_APP_SHUTDOWN_SIGNALS_H_
#define FLATLIGHT_SERVER_APP_SHUTDOWN_SIGNALS_H_

#include <csignal>
#include <functional>

namespace flatlight {

// SIGTERM, SIGINT, SIGHUP, and the end of standard input, as things to wait for. To be made before any thread starts,
// since threads inherit which signals are blocked.
class ShutdownSignals {
 public:
  ShutdownSignals();

  // Returns at the first SIGTERM or SIGINT, or with `watch_stdin` at the end of standard input. From then on a signal
  // ends the process at once. Until then, each SIGHUP calls `reload`, and `tidy` is called about every 5 s.
  void Await(bool watch_stdin, const std::function<void()>& reload, const std::function<void()>& tidy) const;

 private:
  sigset_t signals_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_APP_SHUTDOWN_SIGNALS_H_
