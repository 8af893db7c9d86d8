// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_TLS_CERTIFICATE_AUTHORITY_H_
#define FLATLIGHT_TESTS_SUPPORT_TLS_CERTIFICATE_AUTHORITY_H_

#include <chrono>
#include <string>

namespace flatlight::testing {

// Signs certificates. All texts are in PEM form; keys are of the curve P-256.
class CertificateAuthority {
 public:
  explicit CertificateAuthority(const std::string& name);

  struct Issued {
    std::string certificate;
    std::string key;
  };
  // For 127.0.0.1 and localhost, valid from `from` hours after now until `to`.
  Issued Issue(const std::string& name, std::chrono::hours from = std::chrono::hours(-1),
               std::chrono::hours to = std::chrono::hours(1)) const;

  const std::string& certificate() const { return own_.certificate; }

 private:
  Issued own_;
};

}  // namespace flatlight::testing

#endif  // FLATLIGHT_TESTS_SUPPORT_TLS_CERTIFICATE_AUTHORITY_H_
