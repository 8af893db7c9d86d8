// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_APP_SHUTDOWN_SIGNALS_H_
#define FLATLIGHT_SERVER_APP_SHUTDOWN_SIGNALS_H_

#include <csignal>

namespace flatlight {

// SIGTERM, SIGINT, and the end of standard input, as things to wait for. To be made before any thread starts, since
// threads inherit which signals are blocked.
class ShutdownSignals {
 public:
  ShutdownSignals();

  // Returns at the first signal, or with `watch_stdin` at the end of standard input. From then on a signal ends the
  // process at once.
  void Await(bool watch_stdin) const;

 private:
  sigset_t signals_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_APP_SHUTDOWN_SIGNALS_H_
