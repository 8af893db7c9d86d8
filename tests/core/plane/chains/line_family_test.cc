// SPDX-License-Identifier: Apache-2.0
#include "core/plane/chains/line_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace flatlight {
namespace {

// Lines through the origin; none beyond `last`, and before it they turn as its root.
template <typename Emit, typename GiveUp>
void FitUpTo(double last, double width, double least_part, const Emit& emit, const GiveUp& give_up) {
  const auto line = [&](double x) -> std::optional<DirectedLine> {
    if (x > last) return std::nullopt;
    const double angle = std::sqrt((last - x) / width);
    return DirectedLine{{std::cos(angle), std::sin(angle)}, 0};
  };
  LineFamily::Fit(0, width, line, [&](double begin, double) { return begin < last; }, emit, give_up,
                  {.tolerance = 1e-11, .least_part = least_part, .shift = {}});
}

// However short the whole is, Fit() tells of what is neither in a family nor past the last line.
TEST(LineFamilyTest, TellsWhatWasGivenUp) {
  for (const double width : {1.0, 1e-6, 1e-9, 1e-10}) {
    const double last = 0.4375 * width;
    double covered = 0, off = 0;
    FitUpTo(
        last, width, 1e-6, [&](const LineFamily& lines) { covered += lines.end - lines.begin; },
        [&](double begin, double end) {
          EXPECT_LT(begin, end);
          EXPECT_LT(begin, last);
          off += end - begin;
        });
    EXPECT_GE(covered + off, last) << width;
    EXPECT_GT(off, 0) << width;
    EXPECT_LE(off, 64 * std::max(1e-6 * width, 16 * LineFamily::kOverlap)) << width;
  }
}

}  // namespace
}  // namespace flatlight
