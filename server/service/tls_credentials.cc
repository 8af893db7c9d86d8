// SPDX-License-Identifier: Apache-2.0
#include "server/service/tls_credentials.h"

#include <grpc/grpc.h>
#include <sys/stat.h>

#include <utility>

namespace flatlight {
namespace {

// gRPC's C++ interface has no way to its C interface for certificates that change.
class Credentials final : public grpc::ServerCredentials {
 public:
  explicit Credentials(grpc_server_credentials* credentials) : credentials_(credentials) {}
  ~Credentials() override { grpc_server_credentials_release(credentials_); }
  Credentials(const Credentials&) = delete;
  Credentials& operator=(const Credentials&) = delete;

  // The guard is asked in each call, not here.
  void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>&) override {}

 private:
  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), credentials_);
  }

  grpc_server_credentials* const credentials_;
};

}  // namespace

TlsCredentials::TlsCredentials(TlsFiles files, std::function<void(const std::string&)> say)
    : files_(std::move(files)), say_(std::move(say)) {}

absl::Status TlsCredentials::Check() const { return ReadTlsFiles(files_).status(); }

std::shared_ptr<grpc::ServerCredentials> TlsCredentials::ForServer() {
  const auto request = files_.client_ca.empty() ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                                                : GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY;
  return std::make_shared<Credentials>(grpc_ssl_server_credentials_create_with_options(
      grpc_ssl_server_credentials_create_options_using_config_fetcher(request, &TlsCredentials::Fetch, this)));
}

TlsCredentials::Mark TlsCredentials::MarkNow() const {
  Mark mark{};
  std::size_t at = 0;
  for (const std::string* path : {&files_.certificate, &files_.key, &files_.client_ca}) {
    struct stat info {};
    if (path->empty() || stat(path->c_str(), &info) != 0) info = {};
    for (const std::int64_t part :
         {static_cast<std::int64_t>(info.st_dev), static_cast<std::int64_t>(info.st_ino),
          static_cast<std::int64_t>(info.st_size), static_cast<std::int64_t>(info.st_mtim.tv_sec),
          static_cast<std::int64_t>(info.st_mtim.tv_nsec)}) {
      mark[at++] = part;
    }
  }
  return mark;
}

grpc_ssl_certificate_config_reload_status TlsCredentials::Fetch(void* self,
                                                                grpc_ssl_server_certificate_config** config) {
  TlsCredentials& own = *static_cast<TlsCredentials*>(self);
  const std::lock_guard lock(own.mutex_);
  // Before they are read: what changes meanwhile is seen the next time.
  const Mark mark = own.MarkNow();
  if (own.serving_ && mark == own.seen_) return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
  own.seen_ = mark;
  const auto identity = ReadTlsFiles(own.files_);
  if (!identity.ok()) {
    own.say_("goes on with the certificate it has: " + std::string(identity.status().message()));
    return own.serving_ ? GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED : GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_FAIL;
  }
  const grpc_ssl_pem_key_cert_pair pair{identity->key.c_str(), identity->certificate.c_str()};
  // gRPC insists on some, also where callers are not asked for a certificate and nothing is held against them.
  const std::string& roots = identity->client_ca.empty() ? identity->certificate : identity->client_ca;
  *config = grpc_ssl_server_certificate_config_create(roots.c_str(), &pair, 1);
  if (own.serving_) own.say_("takes the changed TLS files, with the certificate " + own.files_.certificate);
  own.serving_ = true;
  return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
}

}  // namespace flatlight
