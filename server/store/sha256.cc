// SPDX-License-Identifier: Apache-2.0
#include "server/store/sha256.h"

#include <openssl/evp.h>

#include <algorithm>

#include "absl/strings/escaping.h"

namespace flatlight {

namespace {

// EVP_sha256() would be looked up anew with every hash.
const EVP_MD* Algorithm() {
  static const EVP_MD* const kAlgorithm = EVP_MD_fetch(nullptr, "SHA256", nullptr);
  return kAlgorithm;
}

struct Digest {
  EVP_MD_CTX* evp = EVP_MD_CTX_new();
  Digest() { Begin(); }
  ~Digest() { EVP_MD_CTX_free(evp); }
  void Begin() { EVP_DigestInit_ex(evp, Algorithm(), nullptr); }
  std::string Finish() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    EVP_DigestFinal_ex(evp, digest, &size);
    return absl::BytesToHexString({reinterpret_cast<const char*>(digest), size});
  }
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;
};

}  // namespace

struct Sha256::Context : Digest {};

Sha256::Sha256() : context_(std::make_unique<Context>()) {}
Sha256::~Sha256() = default;

void Sha256::Add(std::string_view bytes) { EVP_DigestUpdate(context_->evp, bytes.data(), bytes.size()); }

std::string Sha256::Finish() { return context_->Finish(); }

std::string Sha256Of(std::string_view bytes) {
  // With every call of a user: to make a context costs more than to hash a token.
  thread_local Digest context;
  context.Begin();
  EVP_DigestUpdate(context.evp, bytes.data(), bytes.size());
  return context.Finish();
}

bool IsSha256(std::string_view text) {
  return text.size() == 64 &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

}  // namespace flatlight
