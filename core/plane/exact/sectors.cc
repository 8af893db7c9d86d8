// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/sectors.h"

#include <cstring>
#include <limits>

namespace flatlight {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kBeyond = 4;  // A key that nothing reaches.

// As many zeros as there are bins, then as many ones.
constexpr std::array<std::uint32_t, 2 * Sectors::kBins> kStep = [] {
  std::array<std::uint32_t, 2 * Sectors::kBins> step{};
  for (std::size_t i = Sectors::kBins; i < step.size(); ++i) step[i] = 1;
  return step;
}();

}  // namespace

void Sectors::Start(std::uint32_t first_end, std::uint32_t last_end) {
  if (sectors_.empty()) Grow();
  std::fill_n(keys_.begin(), size_ + 2, kBeyond);
  size_ = 1;
  sectors_[0] = {-1, Sector::kNothing, first_end};
  sectors_[1] = {1, Sector::kNothing, last_end};
  keys_[0] = -1;
  far_squared_[0] = kInfinity;
  first_.fill(0);
}

void Sectors::Grow() {
  const std::size_t room = std::max<std::size_t>(64, 2 * sectors_.size());
  sectors_.resize(room);
  keys_.resize(room + kPadding, kBeyond);
  far_squared_.resize(room + kPadding, kInfinity);
}

void Sectors::Split(std::size_t i, const Sector* others, const double* far_squared, std::size_t count) {
  if (size_ + 1 + count > sectors_.size()) Grow();
  const std::size_t place = i + 1, moved = size_ - i;
  Sector* sector = &sectors_[place];
  float* key = &keys_[place];
  float* far = &far_squared_[place];
  std::memmove(sector + count, sector, moved * sizeof(Sector));
  std::memmove(key + count, key, moved * sizeof(float));
  std::memmove(far + count, far, moved * sizeof(float));
  for (std::size_t j = 0; j < count; ++j) {
    sector[j] = others[j];
    key[j] = static_cast<float>(others[j].key);
    far[j] = RoundedUp(far_squared[j]);
  }
  size_ += count;
  for (std::size_t j = 0; j < count; ++j) {
    // One more before all bins beyond its own.
    const std::uint32_t* step = &kStep[kBins - 1 - BinOf(others[j].key)];
    for (std::size_t bin = 0; bin < kBins; ++bin) first_[bin] += step[bin];
  }
}

}  // namespace flatlight
