// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SAMPLING_HASH_H_
#define FLATLIGHT_CORE_SAMPLING_HASH_H_

#include <cstdint>

namespace flatlight {

// A bijection of 64 bits in which every input bit flips every output bit about half the time: the finaliser of
// SplitMix64 (Steele, Lea, Flood 2014; constants from D. Stafford's variant 13).
constexpr std::uint64_t MixBits(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// A key for the child `value` of the key `parent`; children of different parents, and different children of one parent,
// are unrelated.
constexpr std::uint64_t ChildKey(std::uint64_t parent, std::uint64_t value) {
  constexpr std::uint64_t kGoldenRatio = 0x9e3779b97f4a7c15u;  // 2^64 / phi, odd.
  return MixBits(parent ^ MixBits(value * kGoldenRatio + kGoldenRatio));
}

// The upper 53 bits as a number in [0, 1).
constexpr double ToUnitInterval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SAMPLING_HASH_H_
