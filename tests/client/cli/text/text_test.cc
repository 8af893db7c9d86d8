// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

TEST(Numbers, Counts) {
  EXPECT_EQ(FormatCount(0), "0");
  EXPECT_EQ(FormatCount(999), "999");
  EXPECT_EQ(FormatCount(1000), "1.00 k");
  EXPECT_EQ(FormatCount(12.4e6), "12.4 M");
  EXPECT_EQ(FormatCount(999999), "1.00 M");
  EXPECT_EQ(FormatCount(0.5), "0.500");
}

TEST(Numbers, Percents) {
  EXPECT_EQ(FormatPercent(0), "0 %");
  EXPECT_EQ(FormatPercent(0.013), "1.3 %");
  EXPECT_EQ(FormatPercent(0.00042), "0.042 %");
  EXPECT_EQ(FormatPercent(1.2), "120 %");
  EXPECT_EQ(FormatPercent(1e-9), "1e-07 %");
}

TEST(Numbers, Seconds) {
  EXPECT_EQ(FormatSeconds(0), "0 s");
  EXPECT_EQ(FormatSeconds(0.00035), "350 us");
  EXPECT_EQ(FormatSeconds(0.0009999), "1.0 ms");
  EXPECT_EQ(FormatSeconds(0.35), "350 ms");
  EXPECT_EQ(FormatSeconds(3.14), "3.1 s");
  EXPECT_EQ(FormatSeconds(59.4), "59 s");
  EXPECT_EQ(FormatSeconds(59.7), "1:00");
  EXPECT_EQ(FormatSeconds(7385), "2:03:05");
  EXPECT_EQ(FormatSeconds(1e30), "1e+30 s");
}

TEST(Numbers, Bytes) {
  EXPECT_EQ(FormatBytes(1), "1 byte");
  EXPECT_EQ(FormatBytes(1536), "1.50 KiB");
  EXPECT_EQ(FormatBytes(2147483648.0), "2 GiB");
}

TEST(Numbers, ExactTextReadsBackTheSame) {
  for (const double value : {0.1, 1.0 / 3, 5e-324, 1.7976931348623157e308, -0.0, 123456789012345678.0})
    EXPECT_EQ(std::strtod(FormatExactly(value).c_str(), nullptr), value) << value;
  EXPECT_EQ(FormatExactly(0.1), "0.1");
}

TEST(Text, CutsWholeCodePoints) {
  EXPECT_EQ(TextWidth("\u00b12"), 2U);
  EXPECT_EQ(CutToWidth("\u00b1\u00b1x", 1), "\u00b1");
  EXPECT_EQ(CutToWidth("abc", 5), "abc");
  EXPECT_EQ(CutToWidth("abc", 0), "");
}

TEST(Text, NamesCannotSteerTheTerminal) { EXPECT_EQ(Printable("a\x1b[2J\n\x7f"), "a?[2J??"); }

TEST(Text, TablesAlign) {
  EXPECT_EQ(FormatTable({{"a", "b"}, {"long", "", "c"}, {}}, "  "), "  a     b\n  long     c\n\n");
}

}  // namespace
}  // namespace flatlight
