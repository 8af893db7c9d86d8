// SPDX-License-Identifier: Apache-2.0
// AES-256-GCM with a random nonce; the list's name is authenticated with it.
#include "server/service/page_tokens.h"

#include <openssl/evp.h>

#include <cstring>
#include <memory>

#include "absl/strings/escaping.h"
#include "server/store/random_bytes.h"

namespace flatlight {
namespace {

constexpr std::size_t kNonceBytes = 12;
constexpr std::size_t kTagBytes = 16;

// Nonce, the sealed position, tag.
struct Sealed {
  std::array<unsigned char, kNonceBytes> nonce;
  std::array<unsigned char, sizeof(std::uint64_t)> position;
  std::array<unsigned char, kTagBytes> tag;
};
static_assert(sizeof(Sealed) == kNonceBytes + sizeof(std::uint64_t) + kTagBytes);

struct FreeCipher {
  void operator()(EVP_CIPHER_CTX* cipher) const { EVP_CIPHER_CTX_free(cipher); }
};
using Cipher = std::unique_ptr<EVP_CIPHER_CTX, FreeCipher>;

const unsigned char* BytesOf(const std::string& text) { return reinterpret_cast<const unsigned char*>(text.data()); }

}  // namespace

PageTokens::PageTokens() : key_(RandomBytes<32>()) {}

std::string PageTokens::Seal(const std::string& list, std::uint64_t position) const {
  Sealed sealed{RandomBytes<kNonceBytes>(), {}, {}};
  std::array<unsigned char, sizeof(position)> plain = {};
  std::memcpy(plain.data(), &position, sizeof(position));
  const Cipher cipher(EVP_CIPHER_CTX_new());
  int size = 0;
  EVP_EncryptInit_ex(cipher.get(), EVP_aes_256_gcm(), nullptr, key_.data(), sealed.nonce.data());
  EVP_EncryptUpdate(cipher.get(), nullptr, &size, BytesOf(list), static_cast<int>(list.size()));
  EVP_EncryptUpdate(cipher.get(), sealed.position.data(), &size, plain.data(), static_cast<int>(plain.size()));
  EVP_EncryptFinal_ex(cipher.get(), sealed.position.data() + size, &size);
  EVP_CIPHER_CTX_ctrl(cipher.get(), EVP_CTRL_GCM_GET_TAG, kTagBytes, sealed.tag.data());
  return absl::WebSafeBase64Escape({reinterpret_cast<const char*>(&sealed), sizeof(sealed)});
}

std::optional<std::uint64_t> PageTokens::Open(const std::string& list, const std::string& token) const {
  std::string bytes;
  if (!absl::WebSafeBase64Unescape(token, &bytes) || bytes.size() != sizeof(Sealed)) return std::nullopt;
  Sealed sealed = {};
  std::memcpy(&sealed, bytes.data(), sizeof(sealed));
  std::array<unsigned char, sizeof(std::uint64_t)> plain = {};
  const Cipher cipher(EVP_CIPHER_CTX_new());
  int size = 0;
  EVP_DecryptInit_ex(cipher.get(), EVP_aes_256_gcm(), nullptr, key_.data(), sealed.nonce.data());
  EVP_DecryptUpdate(cipher.get(), nullptr, &size, BytesOf(list), static_cast<int>(list.size()));
  EVP_DecryptUpdate(cipher.get(), plain.data(), &size, sealed.position.data(),
                    static_cast<int>(sealed.position.size()));
  EVP_CIPHER_CTX_ctrl(cipher.get(), EVP_CTRL_GCM_SET_TAG, kTagBytes, sealed.tag.data());
  if (EVP_DecryptFinal_ex(cipher.get(), plain.data() + size, &size) != 1) return std::nullopt;
  std::uint64_t position = 0;
  std::memcpy(&position, plain.data(), sizeof(position));
  return position;
}

}  // namespace flatlight
