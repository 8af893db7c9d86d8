// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connection/interruption.h"

#include <grpcpp/client_context.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

sigset_t Signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  struct sigaction hang_up {};
  if (sigaction(SIGHUP, nullptr, &hang_up) == 0 && hang_up.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
  return signals;
}

}  // namespace

Interruption::Interruption() : event_(eventfd(0, EFD_CLOEXEC)) {
  const sigset_t signals = Signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  thread_ = std::thread([this] { Wait(); });
}

Interruption::~Interruption() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  pthread_kill(thread_.native_handle(), SIGTERM);  // Blocked, so it only ends sigwait.
  thread_.join();
  if (event_ >= 0) close(event_);
}

bool Interruption::Requested() const {
  const std::lock_guard lock(mutex_);
  return requested_;
}

bool Interruption::AwaitReadable(int fd) const {
  std::array<pollfd, 2> sources{pollfd{fd, POLLIN, 0}, pollfd{event_, POLLIN, 0}};
  while (sources[0].revents == 0 && sources[1].revents == 0)
    if (poll(sources.data(), sources.size(), -1) < 0 && errno != EINTR) return !Requested();
  return sources[1].revents == 0;
}

bool Interruption::Sleep(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, time, [this] { return requested_; });
}

void Interruption::Guard(grpc::ClientContext* call) {
  const std::lock_guard lock(mutex_);
  call_ = call;
  if (call_ != nullptr && requested_) call_->TryCancel();
}

void Interruption::Wait() {
  const sigset_t signals = Signals();
  for (;;) {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) continue;
    const std::lock_guard lock(mutex_);
    if (ending_) return;
    if (requested_) _exit(static_cast<int>(ExitCode::kInterrupted));
    requested_ = true;
    if (call_ != nullptr) call_->TryCancel();
    changed_.notify_all();
    eventfd_write(event_, 1);
  }
}

}  // namespace flatlight
