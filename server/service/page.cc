// SPDX-License-Identifier: Apache-2.0
#include "server/service/page.h"

#include "server/service/status_convert.h"

namespace flatlight {
namespace {

constexpr std::int32_t kMaxPageSize = 1000;

}  // namespace

absl::StatusOr<Page> ParsePage(const PageTokens& tokens, const std::string& list, std::int32_t page_size,
                               const std::string& page_token) {
  Page page;
  if (page_size < 0 || page_size > kMaxPageSize) {
    return MakeFieldError("page_size", std::to_string(page_size) + "; allowed: 0 to " + std::to_string(kMaxPageSize));
  }
  if (page_size > 0) page.size = static_cast<std::size_t>(page_size);
  if (page_token.empty()) return page;
  page.position = tokens.Open(list, page_token);
  if (page.position) return page;
  return MakeFieldError("page_token",
                        "not one that this server, since it was started, has given you for this list; allowed: the "
                        "next_page_token of the page before, or none, for the first page");
}

}  // namespace flatlight
