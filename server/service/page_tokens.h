// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_PAGE_TOKENS_H_
#define FLATLIGHT_SERVER_SERVICE_PAGE_TOKENS_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace flatlight {

// Positions in lists, sealed: who reads a token learns nothing of where it is, not even whether two are at the same
// place; and a token opens for the list alone that it was made for. With the object the key goes.
class PageTokens {
 public:
  PageTokens();

  // `list` names it, and whose it is.
  std::string Seal(const std::string& list, std::uint64_t position) const;
  // Nothing for a token of another list, a damaged one, and one of other PageTokens.
  std::optional<std::uint64_t> Open(const std::string& list, const std::string& token) const;

 private:
  const std::array<unsigned char, 32> key_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_PAGE_TOKENS_H_
