// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_EXACT_SECTORS_H_
#define FLATLIGHT_CORE_PLANE_EXACT_SECTORS_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flatlight {

// Directions from `key` up to the next sector's, in which one sight is nearest.
struct Sector {
  double key;
  std::int32_t sight;  // A number of the owner's; kNothing.
  std::uint32_t end;   // The same, for the direction at which it begins.
  static constexpr std::int32_t kNothing = -1;
};

// Sectors in the order of their keys from -1 to 1, each with a bound on how far away what it shows may be. Beside the
// last one stands a mark of the end, at key 1.
class Sectors {
 public:
  // One sector that shows nothing.
  void Start(std::uint32_t first_end, std::uint32_t last_end);

  std::size_t size() const { return size_; }
  // Up to and including the mark.
  const Sector& operator[](std::size_t i) const { return sectors_[i]; }
  // No point of it is farther in these directions, squared; infinite if it shows nothing.
  double FarSquared(std::size_t i) const { return static_cast<double>(far_squared_[i]); }

  // The last one that begins at or before a key.
  std::size_t Find(double key) const {
    const std::size_t bin = BinOf(key);
    std::size_t first = First(bin);
    std::size_t count = First(bin + 1) - first + 1;
    while (count > 1) {
      const std::size_t half = count / 2;
      first += half & (std::size_t{0} - static_cast<std::size_t>(sectors_[first + half].key <= key));  // No branch.
      count -= half;
    }
    return first;
  }

  // What one shows from now on.
  void Set(std::size_t i, std::int32_t sight, double far_squared) {
    sectors_[i].sight = sight;
    far_squared_[i] = RoundedUp(far_squared);
  }
  // Splits one at increasing keys beyond its own: `count` (1 or 2) others follow it.
  void Split(std::size_t i, const Sector* others, const double* far_squared, std::size_t count);

  // For searches in single precision: numbers of sectors from a place on, the mark's and kPadding behind it above all
  // keys. A search for what a key shows begins at First(bin of the key).
  static constexpr std::size_t kPadding = 16;
  static constexpr std::size_t kBins = 32;
  static constexpr float kBinsPerKey = 0.5f * kBins;
  std::size_t First(std::size_t bin) const { return bin < kBins ? first_[bin] : size_ - 1; }
  const float* keys() const { return keys_.data(); }
  const float* far_squared() const { return far_squared_.data(); }

 private:
  void Grow();
  static std::size_t BinOf(double key) {
    const int bin = static_cast<int>((key + 1) * (0.5 * kBins));
    return static_cast<std::size_t>(std::clamp(bin, 0, static_cast<int>(kBins) - 1));
  }
  static float RoundedUp(double number) { return static_cast<float>(number * (1 + 0x1p-20)); }

  // Grow by themselves and keep their size, so that no place is made ready twice.
  std::size_t size_ = 0;
  std::vector<Sector> sectors_;
  std::vector<float> keys_;
  std::vector<float> far_squared_;
  // By bin of keys: the last sector that begins in a bin before.
  std::array<std::uint32_t, kBins> first_{};
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_SECTORS_H_
