// SPDX-License-Identifier: Apache-2.0
#include "server/store/random_bytes.h"

#include <sys/random.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "absl/strings/escaping.h"

namespace flatlight {

void FillRandomBytes(unsigned char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t got = getrandom(bytes, count, 0);
    if (got < 0) {
      if (errno == EINTR) continue;
      std::perror("getrandom");
      std::abort();
    }
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
}

std::string RandomHex(std::size_t bytes) {
  std::string random(bytes, '\0');
  FillRandomBytes(reinterpret_cast<unsigned char*>(random.data()), bytes);
  return absl::BytesToHexString(random);
}

std::uint64_t RandomEpoch() {
  std::uint64_t epoch = 0;
  const auto bytes = RandomBytes<sizeof(epoch)>();
  std::memcpy(&epoch, bytes.data(), sizeof(epoch));
  return (epoch >> 11) | 1;
}

}  // namespace flatlight
