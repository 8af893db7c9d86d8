// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/session.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// The first line of --token-file, or the variable.
absl::StatusOr<std::string> Token(const CommandLine& line) {
  if (line.token_file.empty()) return Variable("FLATLIGHT_TOKEN");
  std::ifstream file(line.token_file);
  std::string token;
  if (!file.is_open()) return UsageError("--token-file: cannot read " + line.token_file + ": " + std::strerror(errno));
  std::getline(file, token);
  if (token.ends_with('\r')) token.pop_back();
  if (token.empty())
    return UsageError("--token-file: the first line of " + line.token_file + " is empty; a token belongs there");
  return token;
}

// Each option, or its variable.
TlsArguments TlsOf(TlsArguments tls) {
  if (tls.ca.empty()) tls.ca = Variable("FLATLIGHT_TLS_CA");
  if (tls.name.empty()) tls.name = Variable("FLATLIGHT_TLS_NAME");
  if (tls.cert.empty() && tls.key.empty()) {
    tls.cert = Variable("FLATLIGHT_TLS_CERT");
    tls.key = Variable("FLATLIGHT_TLS_KEY");
  }
  return tls;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Session>> Session::Open(const CommandLine& line, WithoutServer without,
                                                       Interruption& interruption) {
  auto session = std::make_unique<Session>();
  std::string text = line.server, source = "--server";
  auto token = Token(line);
  if (!token.ok()) return token.status();
  if (text.empty()) {
    text = Variable("FLATLIGHT_SERVER");
    source = "FLATLIGHT_SERVER";
  }
  if (text.empty()) {
    if (without == WithoutServer::kRefuse)
      return UsageError(
          "`flatlight " + line.command +
          "` needs a server, as jobs outlive the command: give --server HOST:PORT or set FLATLIGHT_SERVER");
    if (line.tls.any())
      return UsageError("--tls-… is for a server of another's: give --server, or set FLATLIGHT_SERVER");
    auto server = PrivateServer::Start(line.settings.threads());
    if (!server.ok()) return server.status();
    session->server_ = *std::move(server);
    if (absl::Status ready = session->server_->WaitUntilReady(interruption); !ready.ok()) return ready;
    text = session->server_->address();
    token = session->server_->token();
  }
  const auto address = ParseServerAddress(text, source);
  if (!address.ok()) return address.status();
  const auto tls = session->is_private() ? Tls() : ReadTls(TlsOf(line.tls), !address->local);
  if (!tls.ok()) return tls.status();
  auto connection = Connection::Open(*address, *tls, *token, interruption);
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
