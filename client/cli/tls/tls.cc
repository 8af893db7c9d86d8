// SPDX-License-Identifier: Apache-2.0
#include "client/cli/tls/tls.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

absl::StatusOr<std::string> Read(const std::string& path, const std::string& option) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();  // An iterator would throw at a folder.
  if (!text.str().empty()) return text.str();
  return UsageError(option + ": cannot read " + path + ": " + (errno != 0 ? std::strerror(errno) : "it is empty"));
}

BIO* Open(const std::string& text) { return BIO_new_mem_buf(text.data(), static_cast<int>(text.size())); }

X509* FirstCertificate(const std::string& text) {
  BIO* const bio = Open(text);
  X509* const certificate = PEM_read_bio_X509(bio, nullptr, nullptr, nullptr);
  BIO_free(bio);
  return certificate;
}

EVP_PKEY* FirstKey(const std::string& text) {
  BIO* const bio = Open(text);
  EVP_PKEY* const key = PEM_read_bio_PrivateKey(
      bio, nullptr, [](char*, int, int, void*) { return -1; }, nullptr);
  BIO_free(bio);
  return key;
}

// gRPC says nothing of what is wrong with these.
absl::Status Check(const Tls& tls) {
  const auto none = [](const std::string& option, const std::string& path) {
    return UsageError(option + ": " + path + " holds no certificate in PEM form");
  };
  if (!tls.ca.empty()) {
    X509* const ca = FirstCertificate(tls.ca);
    X509_free(ca);
    if (ca == nullptr) return none("--tls-ca", tls.arguments.ca);
  }
  if (tls.cert.empty()) return absl::OkStatus();
  X509* const cert = FirstCertificate(tls.cert);
  EVP_PKEY* const key = FirstKey(tls.key);
  const bool match = cert != nullptr && key != nullptr && X509_check_private_key(cert, key) == 1;
  const bool expired = cert != nullptr && X509_cmp_current_time(X509_get0_notAfter(cert)) < 0;
  X509_free(cert);
  EVP_PKEY_free(key);
  if (cert == nullptr) return none("--tls-cert", tls.arguments.cert);
  if (key == nullptr)
    return UsageError("--tls-key: " + tls.arguments.key +
                      " holds no private key in PEM form, or one with a passphrase");
  if (!match)
    return UsageError("--tls-key: " + tls.arguments.key + " is not the key of the certificate " + tls.arguments.cert);
  if (expired) return UsageError("--tls-cert: the certificate " + tls.arguments.cert + " has expired");
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Tls> ReadTls(const TlsArguments& arguments, bool other_machine) {
  Tls tls;
  tls.arguments = arguments;
  tls.on = arguments.any() || other_machine;
  if (arguments.cert.empty() != arguments.key.empty())
    return UsageError("--tls-cert and --tls-key belong together: a certificate, and its private key");
  struct File {
    const std::string& path;
    const char* option;
    std::string& text;
  };
  for (const File& file : {File{arguments.ca, "--tls-ca", tls.ca}, File{arguments.cert, "--tls-cert", tls.cert},
                           File{arguments.key, "--tls-key", tls.key}}) {
    if (file.path.empty()) continue;
    auto text = Read(file.path, file.option);
    if (!text.ok()) return text.status();
    file.text = *std::move(text);
  }
  const absl::Status good = Check(tls);
  ERR_clear_error();
  if (!good.ok()) return good;
  return tls;
}

std::string TlsHint(const Tls& tls, const std::string& error) {
  const auto says = [&](const char* part) { return error.find(part) != std::string::npos; };
  if (!tls.on) {
    return says("Socket closed") || says("reset by peer") ? " (does it speak TLS? Then give --tls-ca)" : "";
  }
  if (says("certificate verify failed")) {
    const std::string who = tls.ca.empty() ? "this system's authorities (see --tls-ca)" : tls.arguments.ca;
    return " (its certificate has expired, or was not signed by " + who + ")";
  }
  if (says("Peer name") || says("Hostname Verification")) return " (its certificate has another name; see --tls-name)";
  if (says("WRONG_VERSION_NUMBER") || says("wrong version number")) return " (it does not speak TLS)";
  if (tls.cert.empty() && (says("Socket closed") || says("certificate required") || says("reset by peer") ||
                           says("alert handshake failure") || says("CERTIFICATE_REQUIRED")))
    return " (does it ask for certificates? Then give --tls-cert and --tls-key)";
  return "";
}

}  // namespace flatlight
