// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_MASK_BYTE_H_
#define FLATLIGHT_CORE_PLANE_MASK_BYTE_H_

#include <cstdint>

namespace flatlight {

// The bits of a mask of at most 8 lanes as a number. GCC 12 may save a mask register's one byte on the stack and then
// read four bytes from there, three of them rubbish: it must make it a number first.
inline __attribute__((always_inline)) std::uint32_t NumberOf(std::uint8_t mask) {
  std::uint32_t number = mask;
#if defined(__GNUC__) && !defined(__clang__)
  __asm__("" : "+r"(number));
#endif
  return number;
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_MASK_BYTE_H_
