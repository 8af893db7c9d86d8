// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_TLS_FILES_H_
#define FLATLIGHT_SERVER_SERVICE_TLS_FILES_H_

#include <string>

#include "absl/status/statusor.h"

namespace flatlight {

// Paths of the PEM files of a server that speaks TLS.
struct TlsFiles {
  std::string certificate;  // The server's own first, then those between it and the root. Empty: no TLS.
  std::string key;          // The private key of the first, without a passphrase.
  std::string client_ca;    // Those who vouch for callers, which then must have a certificate; empty: they need none.
};

// What the files hold, as text.
struct TlsIdentity {
  std::string certificate;
  std::string key;
  std::string client_ca;
};

// INVALID_ARGUMENT with BAD_CERTIFICATE, and the file's name: it cannot be read, holds nothing of its kind, the key is
// another certificate's, or now is not within the time for which the server's certificate is valid.
absl::StatusOr<TlsIdentity> ReadTlsFiles(const TlsFiles& files);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_TLS_FILES_H_
