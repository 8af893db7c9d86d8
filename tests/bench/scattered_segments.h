// SPDX-License-Identifier: Apache-2.0
// "Random segments" as benchmarks mean them: middles uniform in the unit square, directions uniform, one length. How
// long they are for their number decides how far one sees, so benchmarks take several rules.
#ifndef FLATLIGHT_TESTS_BENCH_SCATTERED_SEGMENTS_H_
#define FLATLIGHT_TESTS_BENCH_SCATTERED_SEGMENTS_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/description.h"

namespace flatlight {

// The length of each of `count` segments: factor / sqrt(count), or the factor itself. A ray then goes about
// pi / (2 * factor * sqrt(count)) or pi / (2 * factor * count) until it hits one.
struct LengthRule {
  double factor = 0.5;
  bool shrinks = true;

  double For(int count) const;
  std::string Name() const;  // "0.5/sqrt(n)" or "0.05".
};
inline constexpr std::array<LengthRule, 4> kLengthRules = {{{0.5, true}, {1, true}, {0.1, true}, {0.05, false}}};

// They may cross, and reach beyond the square by half their length.
std::vector<SegmentDescription> ScatteredSegments(int count, double length, std::uint64_t seed);

// None crosses or touches another or the square's border: each is drawn again until it fits. Empty if there is no room:
// when one segment did not fit a million times.
std::optional<std::vector<SegmentDescription>> ScatteredApart(int count, double length, std::uint64_t seed);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_SCATTERED_SEGMENTS_H_
