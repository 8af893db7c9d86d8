// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_TLS_TLS_H_
#define FLATLIGHT_CLIENT_CLI_TLS_TLS_H_

#include <string>

#include "absl/status/statusor.h"

namespace flatlight {

// As the user gave them; empty: not given.
struct TlsArguments {
  std::string ca;    // A PEM file of those who may vouch for the server; else the system's.
  std::string cert;  // PEM files of the user's own certificate, if the server asks for one, and its private key.
  std::string key;
  std::string name;  // The server's in its certificate, where that is not the address.

  bool any() const { return !ca.empty() || !cert.empty() || !key.empty() || !name.empty(); }
};

// What a connection needs.
struct Tls {
  bool on = false;
  TlsArguments arguments;
  std::string ca;  // Contents of the files.
  std::string cert;
  std::string key;
};

// TLS is on if anything was given, and always with another machine: a token never goes there in the clear. Errors, with
// the file's name, end with ExitCode::kUsage.
absl::StatusOr<Tls> ReadTls(const TlsArguments& arguments, bool other_machine);

// What a failed connection may mean, as a sentence in brackets to be put behind gRPC's own; empty: nothing to say.
std::string TlsHint(const Tls& tls, const std::string& error);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_TLS_TLS_H_
