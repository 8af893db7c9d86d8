// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SAMPLING_SAMPLE_STREAM_H_
#define FLATLIGHT_CORE_SAMPLING_SAMPLE_STREAM_H_

#include <cstdint>

#include "core/sampling/hash.h"
#include "core/sampling/sobol.h"

namespace flatlight {

// Two numbers in [0, 1).
struct SamplePair {
  double u = 0;
  double v = 0;
};

// The random numbers of one replicate at one point: a pure function of what is asked for, so that any piece of work can
// be done anywhere, in any order. Over the indices 0 ... 2^k - 1 each pair is a (0, k, 2)-net: every elementary
// interval of area 2^-k holds one point. Different dimensions, replicates, points and seeds are scrambled
// independently; a single number of a stream is uniform. Padded pairs after Burley 2020.
class SampleStream {
 public:
  SampleStream(std::uint64_t seed, std::uint64_t point, std::uint64_t replicate)
      : key_(ChildKey(ChildKey(ChildKey(0, seed), point), replicate)) {}

  SamplePair Pair(std::uint32_t index, std::uint32_t dimension) const {
    const std::uint64_t key = ChildKey(key_, dimension);
    const auto shuffled =
        ReverseBits(static_cast<std::uint32_t>(ScrambleReversed(ReverseBits(index), MixBits(key ^ kShuffle))));
    const std::uint64_t u = ScrambleReversed(shuffled, MixBits(key ^ kFirst));
    const std::uint64_t v = ScrambleReversed(SobolSecondDimension(shuffled), MixBits(key ^ kSecond));
    return {ToUnitInterval(ReverseBits(u)), ToUnitInterval(ReverseBits(v))};
  }

  // A number in [0, 1) without stratification, independent of the pairs.
  double Single(std::uint32_t index, std::uint32_t dimension) const {
    return ToUnitInterval(ChildKey(ChildKey(key_ ^ kSingle, dimension), index));
  }

 private:
  // Arbitrary: they tell the uses of one key apart.
  static constexpr std::uint64_t kShuffle = 0x243f6a8885a308d3u;
  static constexpr std::uint64_t kFirst = 0x13198a2e03707344u;
  static constexpr std::uint64_t kSecond = 0xa4093822299f31d0u;
  static constexpr std::uint64_t kSingle = 0x082efa98ec4e6c89u;

  std::uint64_t key_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SAMPLING_SAMPLE_STREAM_H_
