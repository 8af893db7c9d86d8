// SPDX-License-Identifier: Apache-2.0
#include "server/service/page.h"

#include <charconv>

#include "server/service/status_convert.h"

namespace flatlight {
namespace {

constexpr std::int32_t kMaxPageSize = 1000;
constexpr char kTokenPrefix = 'p';

}  // namespace

absl::StatusOr<Page> ParsePage(std::int32_t page_size, const std::string& page_token) {
  Page page;
  if (page_size < 0 || page_size > kMaxPageSize) {
    return MakeFieldError("page_size", std::to_string(page_size) + "; allowed: 0 to " + std::to_string(kMaxPageSize));
  }
  if (page_size > 0) page.size = static_cast<std::size_t>(page_size);
  if (!page_token.empty()) {
    std::uint64_t position = 0;
    const char* end = page_token.data() + page_token.size();
    const auto read = std::from_chars(page_token.data() + 1, end, position);
    if (page_token[0] != kTokenPrefix || read.ec != std::errc() || read.ptr != end) {
      return MakeFieldError("page_token", "not a token that this server gave out");
    }
    page.position = position;
  }
  return page;
}

std::string PageToken(std::uint64_t position) { return kTokenPrefix + std::to_string(position); }

}  // namespace flatlight
