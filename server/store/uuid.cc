// SPDX-License-Identifier: Apache-2.0
#include "server/store/uuid.h"

#include "absl/strings/escaping.h"
#include "server/store/random_bytes.h"

namespace flatlight {
namespace {

constexpr std::size_t kUuidLength = 36;

bool IsDashPlace(std::size_t i) { return i == 8 || i == 13 || i == 18 || i == 23; }

}  // namespace

std::string RandomUuid() {
  auto bytes = RandomBytes<16>();
  bytes[6] = static_cast<unsigned char>((bytes[6] & 0x0f) | 0x40);
  bytes[8] = static_cast<unsigned char>((bytes[8] & 0x3f) | 0x80);
  std::string uuid = absl::BytesToHexString({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  for (std::size_t i = 0; i < kUuidLength; ++i)
    if (IsDashPlace(i)) uuid.insert(i, 1, '-');
  return uuid;
}

bool IsUuid(std::string_view text) {
  if (text.size() != kUuidLength) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool digit = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
    if (IsDashPlace(i) ? c != '-' : !digit) return false;
  }
  return true;
}

}  // namespace flatlight
