// SPDX-License-Identifier: Apache-2.0
// SIGINT and SIGTERM as a flag that ends waiting calls.
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
// ExitCode::kInterrupted. Make it before any other thread: it blocks both signals in the calling thread, and so in all
// that follow.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  bool Requested() const;

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
  std::thread thread_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_INTERRUPTION_H_
