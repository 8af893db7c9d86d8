// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/server_choice.h"

#include <cstdlib>
#include <string>
#include <utility>

#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
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

absl::StatusOr<std::optional<ServerChoice>> ChosenServer(const CommandLine& line) {
  const std::string text = line.server.empty() ? Variable("FLATLIGHT_SERVER") : line.server;
  if (text.empty()) {
    if (!line.tls.any()) return std::nullopt;
    return UsageError("--tls-… is for a server of another's: give --server, or set FLATLIGHT_SERVER");
  }
  auto address = ParseServerAddress(text, line.server.empty() ? "FLATLIGHT_SERVER" : "--server");
  if (!address.ok()) return address.status();
  auto tls = ReadTls(TlsOf(line.tls), !address->local);
  if (!tls.ok()) return tls.status();
  return ServerChoice{*std::move(address), *std::move(tls)};
}

}  // namespace flatlight
