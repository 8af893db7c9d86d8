// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_SHA256_H_
#define FLATLIGHT_SERVER_STORE_SHA256_H_

#include <memory>
#include <string>
#include <string_view>

namespace flatlight {

// SHA-256 of bytes that come in pieces.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void Add(std::string_view bytes);
  // 64 lower-case hexadecimal digits. To be called once, last.
  std::string Finish();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

std::string Sha256Of(std::string_view bytes);

// Whether `text` is 64 lower-case hexadecimal digits.
bool IsSha256(std::string_view text);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_SHA256_H_
