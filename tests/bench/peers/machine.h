// SPDX-License-Identifier: Apache-2.0
// Where and of what a measurement was made.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_MACHINE_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_MACHINE_H_

#include <string>

namespace flatlight {

struct Machine {
  std::string processor;    // Its model's name; "unknown" if the system does not tell.
  std::string vector_unit;  // The widest that it has: AVX-512, AVX2, SSE4.2, NEON.
  std::string compiler;
  std::string build;  // See BuildName.
  std::string date;   // UTC, ISO 8601.
};

Machine ThisMachine();

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_MACHINE_H_
