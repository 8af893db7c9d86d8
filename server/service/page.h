// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_PAGE_H_
#define FLATLIGHT_SERVER_SERVICE_PAGE_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"

namespace flatlight {

// One page of a list: page_size and page_token of a request, checked.
struct Page {
  std::size_t size = 100;
  std::optional<std::uint64_t> position;  // From the token; absent on the first page.
};

absl::StatusOr<Page> ParsePage(std::int32_t page_size, const std::string& page_token);
std::string PageToken(std::uint64_t position);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_PAGE_H_
