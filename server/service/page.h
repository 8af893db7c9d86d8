// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_PAGE_H_
#define FLATLIGHT_SERVER_SERVICE_PAGE_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "server/service/page_tokens.h"

namespace flatlight {

// One page of a list: page_size and page_token of a request, checked. The lists of this server go by positions that
// stay when other things come or go: who turns the pages sees all that is there from the first page to the last, once
// each.
struct Page {
  std::size_t size = 100;
  std::optional<std::uint64_t> position;  // From the token; absent on the first page.
};

// `list`: see PageTokens.
absl::StatusOr<Page> ParsePage(const PageTokens& tokens, const std::string& list, std::int32_t page_size,
                               const std::string& page_token);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_PAGE_H_
