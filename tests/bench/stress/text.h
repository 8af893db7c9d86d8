// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_TEXT_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_TEXT_H_

#include <sstream>
#include <string>

namespace flatlight::stress {

// Everything in a row, numbers with all their digits.
template <typename... Parts>
std::string Text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  return out.str();
}

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_TEXT_H_
