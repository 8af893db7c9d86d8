// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_SESSION_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_SESSION_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/connection/connection.h"
#include "client/cli/connection/private_server.h"
#include "client/cli/options/command_line.h"

namespace flatlight {

// A command's connection, and its private server if it has one.
class Session {
 public:
  enum class WithoutServer { kStartOne, kRefuse };

  // The server is that of --server, or else of FLATLIGHT_SERVER. Without either a private one is started, or the
  // command is refused as bad usage because its job would die with it.
  static absl::StatusOr<std::unique_ptr<Session>> Open(const CommandLine& line, WithoutServer without,
                                                       Interruption& interruption);

  Connection& connection() { return *connection_; }
  bool is_private() const { return server_ != nullptr; }
  // The path of a private server's program.
  const std::string& server_program() const { return server_->program(); }
  // OK unless a private server has ended by itself.
  absl::Status CheckServer() { return server_ == nullptr ? absl::OkStatus() : server_->CheckAlive(); }
  // What ended a private server says more than that it cannot be reached; else `error` as it is.
  absl::Status Explain(const absl::Status& error);

 private:
  std::unique_ptr<PrivateServer> server_;  // Outlives the connection to it.
  std::unique_ptr<Connection> connection_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_SESSION_H_
