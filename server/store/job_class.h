// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_JOB_CLASS_H_
#define FLATLIGHT_SERVER_STORE_JOB_CLASS_H_

#include <cstddef>
#include <cstdint>

namespace flatlight {

// What a job is for; the sooner somebody looks at it, the sooner its turn comes. In order of precedence.
enum class JobClass : std::uint8_t { kInteractive, kGraded, kRegrade };

inline constexpr std::size_t kJobClasses = 3;

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_JOB_CLASS_H_
