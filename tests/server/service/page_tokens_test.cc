// SPDX-License-Identifier: Apache-2.0
#include "server/service/page_tokens.h"

#include <gtest/gtest.h>

#include <string>

namespace flatlight {
namespace {

TEST(PageTokens, OpenWhatTheySealed) {
  const PageTokens tokens;
  for (const std::uint64_t position : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    EXPECT_EQ(tokens.Open("list", tokens.Seal("list", position)), position);
  }
}

TEST(PageTokens, TellNothingOfThePosition) {
  const PageTokens tokens;
  const std::string token = tokens.Seal("list", 7);
  EXPECT_NE(tokens.Seal("list", 7), token);
  EXPECT_EQ(tokens.Seal("list", ~std::uint64_t{0}).size(), token.size());
}

TEST(PageTokens, AreGoodForOneListAlone) {
  const PageTokens tokens, others;
  const std::string token = tokens.Seal("jobs of ada", 7);
  EXPECT_FALSE(tokens.Open("jobs of bob", token));
  EXPECT_FALSE(tokens.Open("jobs of adam", token));
  EXPECT_FALSE(tokens.Open("", token));
  EXPECT_FALSE(others.Open("jobs of ada", token));
}

TEST(PageTokens, DamagedOnesAreNotOpened) {
  const PageTokens tokens;
  const std::string token = tokens.Seal("list", 7);
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string damaged = token;
    damaged[i] = damaged[i] == 'A' ? 'B' : 'A';
    EXPECT_FALSE(tokens.Open("list", damaged)) << i;
  }
  for (const std::string& bad : {std::string(), std::string("p7"), token.substr(1), token + "A", token + token,
                                 "!" + token.substr(1), std::string(1'000'000, 'A')}) {
    EXPECT_FALSE(tokens.Open("list", bad)) << bad.substr(0, 60);
  }
}

}  // namespace
}  // namespace flatlight
