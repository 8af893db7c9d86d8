// SPDX-License-Identifier: Apache-2.0
// SIGINT, SIGTERM and SIGHUP as a flag that ends waiting calls and reads.
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_INTERRUPTION_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_INTERRUPTION_H_

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace grpc {
class ClientContext;
}

namespace flatlight {

// The first signal cancels the running call and sets the flag; the second ends the program at once with
// ExitCode::kInterrupted. Make it before any other thread: it blocks the signals in the calling thread, and so in all
// that follow. SIGHUP stays ignored where it is (nohup).
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  bool Requested() const;

  // Waits until `fd` can be read from without blocking (or has an end, or an error, to be read). False as soon as a
  // signal comes.
  bool AwaitReadable(int fd) const;

  // False as soon as a signal comes, true after the whole time.
  bool Sleep(std::chrono::milliseconds time);

  // The call to cancel on a signal, at once if there was one already. One call at a time; null when it has ended.
  void Guard(grpc::ClientContext* call);

 private:
  void Wait();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool requested_ = false;  // Guarded by mutex_, as is all below.
  bool ending_ = false;
  grpc::ClientContext* call_ = nullptr;
  int event_;  // Can be read from once a signal has come.
  std::thread thread_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_INTERRUPTION_H_
