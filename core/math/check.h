// SPDX-License-Identifier: Apache-2.0
// Contracts between parts of the program. Bad input never reaches them: it is refused where it enters.
#ifndef FLATLIGHT_CORE_MATH_CHECK_H_
#define FLATLIGHT_CORE_MATH_CHECK_H_

#include <cstdio>
#include <cstdlib>

// Stops the program in debug builds when a contract is broken; costs nothing in release builds.
#ifdef NDEBUG
#define FLATLIGHT_DCHECK(condition) static_cast<void>(sizeof(condition))
#else
#define FLATLIGHT_DCHECK(condition)                                                         \
  do {                                                                                      \
    if (!(condition)) {                                                                     \
      std::fprintf(stderr, "%s:%d: contract broken: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                         \
    }                                                                                       \
  } while (false)
#endif

#endif  // FLATLIGHT_CORE_MATH_CHECK_H_
