// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SAMPLING_SAMPLE_STREAM_H_
#define FLATLIGHT_CORE_SAMPLING_SAMPLE_STREAM_H_

#include <algorithm>
#include <bit>
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
//
// The members of a group share one sequence: each of them is such a net, and over the indices 0 ... 2^k - 1, and over
// either half of the next 2^k, all eight together are one net. What members give is not independent, groups are.
class SampleStream {
 public:
  static constexpr std::uint32_t kMembers = kSharedNets;

  SampleStream(std::uint64_t seed, std::uint64_t point, std::uint64_t replicate)
      : key_(ChildKey(ChildKey(ChildKey(0, seed), point), replicate)), single_key_(key_ ^ kSingle) {}

  // One of the kMembers streams of a group. Groups are independent, of each other and of replicates.
  static SampleStream Member(std::uint64_t seed, std::uint64_t point, std::uint64_t group, std::uint32_t member) {
    SampleStream stream(seed, point, kGroups ^ group);
    stream.single_key_ = ChildKey(stream.single_key_, member);
    stream.member_ = member;
    stream.member_key_ = ChildKey(kMemberShuffle, member);
    return stream;
  }

  SamplePair Pair(std::uint32_t index, std::uint32_t dimension) const {
    const std::uint64_t key = ChildKey(key_, dimension);
    std::uint32_t shuffled = Shuffled(index, MixBits(key ^ kShuffle));
    std::uint32_t first_shift = 0, second_shift = 0;
    if (member_ < kMembers) {
      const std::uint32_t copy = RenamedCopy(member_, key);
      first_shift = kFirstShifts[copy];
      second_shift = kSecondShifts[copy];
      // Within half of what its highest bit allows an index is shuffled for each member apart. Else its eight pairs
      // would be spread evenly over the first digits of every dimension, and the variance of what two dimensions do
      // together would be 1.2 times as large.
      const std::uint32_t own = (std::uint32_t{1} << (std::max<unsigned>(std::bit_width(index), 2) - 2)) - 1;
      shuffled = (shuffled & ~own) | (Shuffled(index, MixBits(key ^ member_key_)) & own);
    }
    const std::uint64_t u = ScrambleReversed(shuffled ^ first_shift, MixBits(key ^ kFirst));
    const std::uint64_t v = ScrambleReversed(SobolSecondDimension(shuffled) ^ second_shift, MixBits(key ^ kSecond));
    return {ToUnitInterval(ReverseBits(u)), ToUnitInterval(ReverseBits(v))};
  }

  // A number in [0, 1) without stratification, independent of the pairs.
  double Single(std::uint32_t index, std::uint32_t dimension) const {
    return ToUnitInterval(ChildKey(ChildKey(single_key_, dimension), index));
  }

 private:
  static std::uint32_t Shuffled(std::uint32_t index, std::uint64_t key) {
    return ReverseBits(static_cast<std::uint32_t>(ScrambleReversed(ReverseBits(index), key)));
  }

  // Arbitrary: they tell the uses of one key apart.
  static constexpr std::uint64_t kShuffle = 0x243f6a8885a308d3u;
  static constexpr std::uint64_t kFirst = 0x13198a2e03707344u;
  static constexpr std::uint64_t kSecond = 0xa4093822299f31d0u;
  static constexpr std::uint64_t kSingle = 0x082efa98ec4e6c89u;
  static constexpr std::uint64_t kGroups = 0x452821e638d01377u;
  static constexpr std::uint64_t kMemberShuffle = 0xbe5466cf34e90c6cu;

  std::uint64_t key_;
  std::uint64_t single_key_;
  std::uint32_t member_ = kMembers;  // kMembers: of no group.
  std::uint64_t member_key_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SAMPLING_SAMPLE_STREAM_H_
