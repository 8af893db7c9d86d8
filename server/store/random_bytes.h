// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_RANDOM_BYTES_H_
#define FLATLIGHT_SERVER_STORE_RANDOM_BYTES_H_

#include <array>
#include <cstddef>
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

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_RANDOM_BYTES_H_
