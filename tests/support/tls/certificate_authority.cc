// SPDX-License-Identifier: Apache-2.0
#include "tests/support/tls/certificate_authority.h"

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <atomic>
#include <memory>

namespace flatlight::testing {
namespace {

struct Free {
  void operator()(BIO* object) const { BIO_free(object); }
  void operator()(X509* object) const { X509_free(object); }
  void operator()(EVP_PKEY* object) const { EVP_PKEY_free(object); }
  void operator()(X509_EXTENSION* object) const { X509_EXTENSION_free(object); }
};
using Bio = std::unique_ptr<BIO, Free>;
using Certificate = std::unique_ptr<X509, Free>;
using Key = std::unique_ptr<EVP_PKEY, Free>;

template <class Write>
std::string TextOf(Write write) {
  const Bio bio(BIO_new(BIO_s_mem()));
  write(bio.get());
  char* begin = nullptr;
  const auto size = BIO_get_mem_data(bio.get(), &begin);
  return {begin, static_cast<std::size_t>(size)};
}

Bio Open(const std::string& text) { return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size()))); }

Certificate NewCertificate(const std::string& name, EVP_PKEY* key, std::chrono::seconds from, std::chrono::seconds to) {
  static std::atomic<int> serial = 1;
  Certificate certificate(X509_new());
  X509_set_version(certificate.get(), X509_VERSION_3);
  ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), serial++);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), from.count());
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), to.count());
  X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate.get()), "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  X509_set_pubkey(certificate.get(), key);
  return certificate;
}

void Extend(X509* certificate, int kind, const char* value) {
  const std::unique_ptr<X509_EXTENSION, Free> extension(X509V3_EXT_conf_nid(nullptr, nullptr, kind, value));
  X509_add_ext(certificate, extension.get(), -1);
}

std::string TextOf(X509* certificate) {
  return TextOf([&](BIO* bio) { PEM_write_bio_X509(bio, certificate); });
}

std::string TextOf(EVP_PKEY* key) {
  return TextOf([&](BIO* bio) { PEM_write_bio_PrivateKey(bio, key, nullptr, nullptr, 0, nullptr, nullptr); });
}

}  // namespace

CertificateAuthority::CertificateAuthority(const std::string& name) {
  const Key key(EVP_EC_gen("P-256"));
  const Certificate certificate = NewCertificate(name, key.get(), std::chrono::hours(-1000), std::chrono::hours(1000));
  X509_set_issuer_name(certificate.get(), X509_get_subject_name(certificate.get()));
  Extend(certificate.get(), NID_basic_constraints, "critical,CA:TRUE");
  X509_sign(certificate.get(), key.get(), EVP_sha256());
  own_ = {TextOf(certificate.get()), TextOf(key.get())};
}

CertificateAuthority::Issued CertificateAuthority::Issue(const std::string& name, std::chrono::hours from,
                                                         std::chrono::hours to) const {
  const Certificate authority(PEM_read_bio_X509(Open(own_.certificate).get(), nullptr, nullptr, nullptr));
  const Key authority_key(PEM_read_bio_PrivateKey(Open(own_.key).get(), nullptr, nullptr, nullptr));
  const Key key(EVP_EC_gen("P-256"));
  const Certificate certificate = NewCertificate(name, key.get(), from, to);
  X509_set_issuer_name(certificate.get(), X509_get_subject_name(authority.get()));
  Extend(certificate.get(), NID_subject_alt_name, "IP:127.0.0.1,DNS:localhost");
  X509_sign(certificate.get(), authority_key.get(), EVP_sha256());
  return {TextOf(certificate.get()), TextOf(key.get())};
}

}  // namespace flatlight::testing
