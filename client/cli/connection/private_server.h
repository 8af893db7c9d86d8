// SPDX-License-Identifier: Apache-2.0
// A server of our own for one command: a child process, on a Unix socket that nobody else can reach.
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_PRIVATE_SERVER_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_PRIVATE_SERVER_H_

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/connection/interruption.h"
#include "client/cli/connection/startup_watch.h"

namespace flatlight {

// Runs the flatlightd that lies beside this program, with its socket in a fresh folder of mode 0700 and a random token
// that only the two know. The server ends when this object or this process does, however that ends: it watches a pipe.
class PrivateServer {
 public:
  // `threads` are for rendering; 0: as many as there are processors. Returns while the server is starting;
  // WaitUntilReady says when it can be called.
  static absl::StatusOr<std::unique_ptr<PrivateServer>> Start(std::uint32_t threads);
  // Ends the server and removes the folder.
  ~PrivateServer();
  PrivateServer(const PrivateServer&) = delete;
  PrivateServer& operator=(const PrivateServer&) = delete;

  // However long that takes on a busy machine, as long as the server gets on: UNAVAILABLE once it has ended, or done
  // nothing for StartupWatch::kIdlePatience. Calls `tell_slow` if it takes long, once.
  absl::Status WaitUntilReady(Interruption& interruption, const std::function<void()>& tell_slow);

  std::string address() const { return "unix:" + socket_; }
  const std::string& token() const { return token_; }
  const std::string& program() const { return program_; }  // The path of flatlightd.

  // OK while the server runs, else UNAVAILABLE with how it ended and the end of what it wrote.
  absl::Status CheckAlive();

 private:
  PrivateServer(std::string program, std::string folder, std::string token);
  absl::Status Spawn(std::uint32_t threads);
  absl::Status NotListening(StartupWatch::Verdict verdict, std::chrono::steady_clock::duration waited) const;
  void Stop();

  std::string program_;
  std::string folder_;
  std::string socket_;
  std::string log_;
  std::string token_;
  pid_t child_ = -1;     // -1 when it has ended.
  int exit_status_ = 0;  // As waitpid gives it.
  int lifeline_ = -1;    // The end of the pipe whose closing ends the server.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_PRIVATE_SERVER_H_
