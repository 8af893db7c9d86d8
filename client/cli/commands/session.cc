// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/session.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include "client/cli/commands/server_choice.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

// The first line of --token-file, or the variable.
absl::StatusOr<std::string> Token(const CommandLine& line) {
  if (line.token_file.empty()) {
    const char* variable = std::getenv("FLATLIGHT_TOKEN");
    return std::string(variable == nullptr ? "" : variable);
  }
  std::ifstream file(line.token_file);
  std::string token;
  if (!file.is_open()) return UsageError("--token-file: cannot read " + line.token_file + ": " + std::strerror(errno));
  std::getline(file, token);
  if (token.ends_with('\r')) token.pop_back();
  if (token.empty())
    return UsageError("--token-file: the first line of " + line.token_file + " is empty; a token belongs there");
  return token;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Session>> Session::Open(const CommandLine& line, WithoutServer without,
                                                       Interruption& interruption) {
  auto session = std::make_unique<Session>();
  auto token = Token(line);
  if (!token.ok()) return token.status();
  auto server = ChosenServer(line);
  if (!server.ok()) return server.status();
  if (!server->has_value()) {
    if (without == WithoutServer::kRefuse)
      return UsageError(
          "`flatlight " + line.command +
          "` needs a server, as jobs outlive the command: give --server HOST:PORT or set FLATLIGHT_SERVER");
    auto own = PrivateServer::Start(line.settings.threads());
    if (!own.ok()) return own.status();
    session->server_ = *std::move(own);
    const auto tell_slow = [&line] {
      if (!line.quiet)
        std::fputs("flatlight: its own server is slow to start; waiting as long as it gets on\n", stderr);
    };
    if (absl::Status ready = session->server_->WaitUntilReady(interruption, tell_slow); !ready.ok()) return ready;
    auto address = ParseServerAddress(session->server_->address(), "TMPDIR");
    if (!address.ok()) return address.status();
    *server = ServerChoice{*std::move(address), Tls()};
    token = session->server_->token();
  }
  // A private server has nobody else to serve.
  Connection::Tell tell;
  if (!session->is_private()) {
    tell = [quiet = line.quiet](const std::string& why) {
      if (!quiet) std::fputs(("flatlight: " + why + "\n").c_str(), stderr);
    };
  }
  auto connection = Connection::Open((*server)->address, (*server)->tls, *token, interruption, std::move(tell));
  if (!connection.ok()) return session->Explain(connection.status());
  session->connection_ = *std::move(connection);
  return session;
}

absl::Status Session::Explain(const absl::Status& error) {
  if (error.code() != absl::StatusCode::kUnavailable) return error;
  const absl::Status alive = CheckServer();
  return alive.ok() ? error : alive;
}

}  // namespace flatlight
