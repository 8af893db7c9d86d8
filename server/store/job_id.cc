// SPDX-License-Identifier: Apache-2.0
#include "server/store/job_id.h"

#include "absl/strings/escaping.h"
#include "server/store/random_bytes.h"

namespace flatlight {
namespace {

constexpr std::size_t kUuidLength = 36;
constexpr std::string_view kPrefix = "jobs/";

bool IsDashPlace(std::size_t i) { return i == 8 || i == 13 || i == 18 || i == 23; }

bool IsUuid(std::string_view text) {
  if (text.size() != kUuidLength) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool digit = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
    if (IsDashPlace(i) ? c != '-' : !digit) return false;
  }
  return true;
}

}  // namespace

// RFC 4122, version 4.
JobId JobId::Random() {
  auto bytes = RandomBytes<16>();
  bytes[6] = static_cast<unsigned char>((bytes[6] & 0x0f) | 0x40);
  bytes[8] = static_cast<unsigned char>((bytes[8] & 0x3f) | 0x80);
  JobId id;
  id.uuid_ = absl::BytesToHexString({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  for (std::size_t i = 0; i < kUuidLength; ++i)
    if (IsDashPlace(i)) id.uuid_.insert(i, 1, '-');
  return id;
}

std::optional<JobId> JobId::FromName(std::string_view name) {
  if (!name.starts_with(kPrefix) || !IsUuid(name.substr(kPrefix.size()))) return std::nullopt;
  JobId id;
  id.uuid_ = name.substr(kPrefix.size());
  return id;
}

}  // namespace flatlight
