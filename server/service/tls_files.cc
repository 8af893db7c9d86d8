// SPDX-License-Identifier: Apache-2.0
#include "server/service/tls_files.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <cerrno>
#include <fstream>
#include <memory>
#include <sstream>
#include <system_error>

#include "server/store/error.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxBytes = 1u << 20;  // A bundle of all public roots has a fifth of that.

template <auto kFree>
struct Free {
  template <class T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using Bio = std::unique_ptr<BIO, Free<BIO_free>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;

absl::Status Bad(const std::string& message) {
  return MakeError(absl::StatusCode::kInvalidArgument, "BAD_CERTIFICATE", message);
}

absl::StatusOr<std::string> Read(const std::string& path, const std::string& what) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();  // An iterator would throw at a folder.
  std::string text = content.str();
  if (text.empty() && errno != 0) {
    return Bad("cannot read " + what + " " + path + ": " + std::generic_category().message(errno));
  }
  if (text.size() > kMaxBytes) return Bad(path + " is longer than " + std::to_string(kMaxBytes) + " bytes");
  return text;
}

Bio Open(const std::string& text) { return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size()))); }

Certificate FirstCertificate(const std::string& text) {
  Certificate certificate(PEM_read_bio_X509(Open(text).get(), nullptr, nullptr, nullptr));
  ERR_clear_error();
  return certificate;
}

Key FirstKey(const std::string& text) {
  // Nobody is there to be asked for a passphrase.
  const auto no_passphrase = [](char*, int, int, void*) { return -1; };
  Key key(PEM_read_bio_PrivateKey(Open(text).get(), nullptr, no_passphrase, nullptr));
  ERR_clear_error();
  return key;
}

std::string DateOf(const ASN1_TIME* time) {
  const Bio text(BIO_new(BIO_s_mem()));
  ASN1_TIME_print(text.get(), time);
  char* begin = nullptr;
  const auto size = BIO_get_mem_data(text.get(), &begin);
  return {begin, static_cast<std::size_t>(size)};
}

absl::Status CheckValidNow(const X509& certificate, const std::string& path) {
  const ASN1_TIME* const from = X509_get0_notBefore(&certificate);
  const ASN1_TIME* const to = X509_get0_notAfter(&certificate);
  if (X509_cmp_current_time(to) < 0) return Bad("the certificate " + path + " expired on " + DateOf(to));
  if (X509_cmp_current_time(from) > 0) return Bad("the certificate " + path + " is valid from " + DateOf(from) + " on");
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<TlsIdentity> ReadTlsFiles(const TlsFiles& files) {
  auto certificate = Read(files.certificate, "the certificate");
  if (!certificate.ok()) return certificate.status();
  auto key = Read(files.key, "the private key");
  if (!key.ok()) return key.status();
  const Certificate own = FirstCertificate(*certificate);
  if (own == nullptr) return Bad(files.certificate + " holds no certificate in PEM form");
  const Key own_key = FirstKey(*key);
  if (own_key == nullptr) return Bad(files.key + " holds no private key in PEM form, or one with a passphrase");
  const bool belongs = X509_check_private_key(own.get(), own_key.get()) == 1;
  ERR_clear_error();
  if (!belongs) return Bad("the private key " + files.key + " is not that of the certificate " + files.certificate);
  if (absl::Status valid = CheckValidNow(*own, files.certificate); !valid.ok()) return valid;
  TlsIdentity identity{*std::move(certificate), *std::move(key), ""};
  if (files.client_ca.empty()) return identity;
  auto client_ca = Read(files.client_ca, "the certificates of those who vouch for callers,");
  if (!client_ca.ok()) return client_ca.status();
  if (FirstCertificate(*client_ca) == nullptr) return Bad(files.client_ca + " holds no certificate in PEM form");
  identity.client_ca = *std::move(client_ca);
  return identity;
}

}  // namespace flatlight
