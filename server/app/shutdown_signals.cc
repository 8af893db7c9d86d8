// SPDX-License-Identifier: Apache-2.0
#include "server/app/shutdown_signals.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace flatlight {
namespace {

constexpr int kTidyMilliseconds = 5000;

// Whether standard input has come to its end; what it brought is thrown away.
bool AtEnd() {
  std::array<char, 512> discarded;
  const ssize_t count = read(STDIN_FILENO, discarded.data(), discarded.size());
  return count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN);
}

}  // namespace

ShutdownSignals::ShutdownSignals() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGTERM);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  // A client that goes away is an error of a call, not of the process.
  std::signal(SIGPIPE, SIG_IGN);
  // So is a file that may not grow.
  std::signal(SIGXFSZ, SIG_IGN);
}

void ShutdownSignals::Await(bool watch_stdin, const std::function<void()>& reload,
                            const std::function<void()>& tidy) const {
  const int signal_fd = signalfd(-1, &signals_, SFD_CLOEXEC);
  if (signal_fd < 0) {
    std::perror("signalfd");
    std::abort();
  }
  std::array<pollfd, 2> sources{pollfd{signal_fd, POLLIN, 0}, pollfd{STDIN_FILENO, POLLIN, 0}};
  const nfds_t count = watch_stdin ? 2 : 1;
  while (true) {
    const int ready = poll(sources.data(), count, kTidyMilliseconds);
    if (ready == 0) tidy();
    if (ready <= 0) continue;
    if (sources[0].revents != 0) {
      signalfd_siginfo taken;
      if (read(signal_fd, &taken, sizeof(taken)) != sizeof(taken)) continue;
      if (taken.ssi_signo != SIGHUP) break;
      reload();
    }
    if (watch_stdin && sources[1].revents != 0 && AtEnd()) break;
  }
  close(signal_fd);
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
}

}  // namespace flatlight
