// SPDX-License-Identifier: Apache-2.0
// The first two dimensions of Sobol's sequence (Sobol 1967) with Owen's nested uniform scrambling (Owen 1995), both
// computed from the index alone.
//
// Scrambling works on digits in reversed order, most significant first in bit 0: then "a digit may be flipped depending
// on the digits above it" becomes "a bit may depend on lower bits only", which addition, multiplication by odd numbers
// and x ^= x * even all respect (Laine and Karras 2011; Burley 2020, Practical Hash-based Owen Scrambling, JCGT 9(4)).
// Unlike there the words have 64 bits: digits below the 32 of the sequence come out as hashes of those above.
#ifndef FLATLIGHT_CORE_SAMPLING_SOBOL_H_
#define FLATLIGHT_CORE_SAMPLING_SOBOL_H_

#include <array>
#include <bit>
#include <cstdint>

namespace flatlight {

constexpr std::uint32_t ReverseBits(std::uint32_t x) {
  x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  return __builtin_bswap32(x);
}

constexpr std::uint64_t ReverseBits(std::uint64_t x) {
  x = ((x & 0x5555555555555555u) << 1) | ((x >> 1) & 0x5555555555555555u);
  x = ((x & 0x3333333333333333u) << 2) | ((x >> 2) & 0x3333333333333333u);
  x = ((x & 0x0f0f0f0f0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0f0f0f0f0fu);
  return __builtin_bswap64(x);
}

// Digits of the second Sobol dimension of point `index`, most significant in bit 0 (those of the first are the index
// itself). The generator matrix is Pascal's triangle modulo 2, a fivefold tensor power of [[1 1] [0 1]]: hence one step
// for each level.
constexpr std::uint32_t SobolSecondDimension(std::uint32_t index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ (index >> 16);
}

// Eight copies of the sequence, each with its digits shifted (added modulo 2), that make up finer nets together: over
// an aligned range of 2^k indices, for any k up to 29, all copies are one (0, k + 3, 2)-net. Digit t of a shift is a
// linear form of the copy's three bits, c_t, the same one again every seven digits. In one dimension any three
// successive forms that are independent will do: they tell copies apart at the first three digits that the indices
// leave open. Of the sequences c_{t+3} = a c_t + b c_{t+1} + c c_{t+2} that have them, these two (c_{t+3} = c_t +
// c_{t+1} and c_t + c_{t+2}) are nets in two dimensions as well; found by trial, and tested by the ranks of all their
// matrices.
inline constexpr std::uint32_t kSharedNets = 8;

// The shifts of all copies, from their seven forms; most significant digit in bit 0.
constexpr std::array<std::uint32_t, kSharedNets> SharedNetShifts(const std::array<std::uint8_t, 7>& forms) {
  std::array<std::uint32_t, kSharedNets> shifts{};
  for (std::uint32_t copy = 0; copy < kSharedNets; ++copy)
    for (unsigned t = 0; t < 32; ++t)
      shifts[copy] |= static_cast<std::uint32_t>(std::popcount(forms[t % 7] & copy) & 1) << t;
  return shifts;
}
inline constexpr std::array<std::uint32_t, kSharedNets> kFirstShifts = SharedNetShifts({1, 2, 4, 3, 6, 7, 5});
inline constexpr std::array<std::uint32_t, kSharedNets> kSecondShifts = SharedNetShifts({6, 4, 1, 7, 3, 2, 5});

// Renames the copies: x -> a x + b in the field of 8 elements, a and b taken from the key. Any two copies come out as
// any two alike likely, so that what they get of two numbers that are renamed independently is unrelated.
constexpr std::uint32_t RenamedCopy(std::uint32_t copy, std::uint64_t key) {
  constexpr std::array<std::uint8_t, 7> kPowers = {1, 2, 4, 3, 6, 7, 5};  // Of x, modulo x^3 + x + 1.
  constexpr std::array<std::uint8_t, 8> kLogarithms = {0, 0, 1, 3, 2, 6, 4, 5};
  const auto b = static_cast<std::uint32_t>(key & 7);
  if (copy == 0) return b;
  const auto a = static_cast<std::uint32_t>((key >> 32) * 7 >> 32);
  return b ^ kPowers[(kLogarithms[copy] + a) % 7];
}

// Nested uniform scrambling of reversed digits. `key` must be well mixed. The sum and the products make each digit
// depend on all above it; the last three steps give the first digits coins that are exactly independent, for which
// every step takes its first eight bits from another part of the key.
constexpr std::uint64_t ScrambleReversed(std::uint64_t x, std::uint64_t key) {
  x += key;
  x *= std::rotr(key, 32) | 1;
  x ^= x * 0xa24baed4963ee406u;  // Even, 2 modulo 4; otherwise arbitrary.
  x ^= (x << 1) & std::rotr(key, 16);
  x ^= (x << 2) & std::rotr(key, 48);
  return x ^ std::rotr(key, 8);
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SAMPLING_SOBOL_H_
