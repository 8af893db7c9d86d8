// SPDX-License-Identifier: Apache-2.0
// Matchers for absl::Status and absl::StatusOr, which Debian's Abseil does not bring.
#ifndef FLATLIGHT_TESTS_SUPPORT_STATUS_STATUS_MATCHERS_H_
#define FLATLIGHT_TESTS_SUPPORT_STATUS_STATUS_MATCHERS_H_

#include <gmock/gmock.h>

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace flatlight::testing {

inline const absl::Status& StatusOf(const absl::Status& status) { return status; }
template <class T>
const absl::Status& StatusOf(const absl::StatusOr<T>& result) {
  return result.status();
}

MATCHER(IsOk, negation ? "is an error" : "is OK") {
  *result_listener << StatusOf(arg).ToString();
  return arg.ok();
}

MATCHER_P2(StatusIs, code, message,
           "is an error " + absl::StatusCodeToString(code) + " whose message " +
               ::testing::DescribeMatcher<std::string>(message, negation)) {
  *result_listener << StatusOf(arg).ToString();
  return StatusOf(arg).code() == code && ::testing::Matches(message)(std::string(StatusOf(arg).message()));
}

}  // namespace flatlight::testing

#endif  // FLATLIGHT_TESTS_SUPPORT_STATUS_STATUS_MATCHERS_H_
