// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_RANDOM_BYTES_H_
#define FLATLIGHT_SERVER_STORE_RANDOM_BYTES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace flatlight {

// Unpredictable bytes, from the operating system. Stops the program if there are none to be had.
void FillRandomBytes(unsigned char* bytes, std::size_t count);

template <std::size_t kCount>
std::array<unsigned char, kCount> RandomBytes() {
  std::array<unsigned char, kCount> bytes;
  FillRandomBytes(bytes.data(), kCount);
  return bytes;
}

// So many of them, as twice as many digits 0-9 a-f.
std::string RandomHex(std::size_t bytes);

// Tells one sequence from another with the same numbers. Not 0, which a watcher sends that knows none; exact in a
// double, for clients that have no 64-bit integers.
std::uint64_t RandomEpoch();

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_RANDOM_BYTES_H_
