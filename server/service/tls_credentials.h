// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_TLS_CREDENTIALS_H_
#define FLATLIGHT_SERVER_SERVICE_TLS_CREDENTIALS_H_

#include <grpc/grpc_security.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "absl/base/thread_annotations.h"
#include "grpcpp/security/server_credentials.h"
#include "server/service/tls_files.h"

namespace flatlight {

// TLS with files that may be replaced while the server runs. They are looked at when a connection is made, and taken if
// they are good as a whole; with a half-written file, or a key that has no certificate yet, connections are made with
// what was good before. (gRPC's own FileWatcherCertificateProvider takes them as they are, and then refuses everybody.)
class TlsCredentials {
 public:
  // `say` is told of files taken and refused, once each.
  TlsCredentials(TlsFiles files, std::function<void(const std::string&)> say);

  // The error of ReadTlsFiles, if a server could not be started with the files as they are.
  absl::Status Check() const;
  // For the server's builder; outlived by this, as is the server.
  std::shared_ptr<grpc::ServerCredentials> ForServer();

 private:
  // Tell one state of the files from another.
  using Mark = std::array<std::int64_t, 15>;

  static grpc_ssl_certificate_config_reload_status Fetch(void* self, grpc_ssl_server_certificate_config** config);
  Mark MarkNow() const;

  const TlsFiles files_;
  const std::function<void(const std::string&)> say_;
  std::mutex mutex_;
  bool serving_ ABSL_GUARDED_BY(mutex_) = false;
  Mark seen_ ABSL_GUARDED_BY(mutex_) = {};
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_TLS_CREDENTIALS_H_
