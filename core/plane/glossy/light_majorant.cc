// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/light_majorant.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace flatlight {
namespace {

// Of the bound, that what is not summed may make it wider than it need be.
constexpr double kWider = 0.2;
// From so many terms on any q < 1 will do.
constexpr int kEnough = 30;
constexpr int kMost = 2000;

}  // namespace

bool LightMajorant::Step(const std::function<void(const Values& in, Values& out)>& map) {
  next_.resize(term_.size());
  map(term_, next_);
  ++steps_;
  double ratio = 0;
  for (std::size_t i = 0; i < next_.size(); ++i) {
    sum_[i] += next_[i];
    if (next_[i] > 0) ratio = std::max(ratio, next_[i] / term_[i]);
  }
  const double rest = ratio < 1 ? ratio / (1 - ratio) : std::numeric_limits<double>::infinity();
  bool small = true;
  for (std::size_t i = 0; i < next_.size() && small; ++i) small = next_[i] == 0 || rest * next_[i] <= kWider * sum_[i];
  if (!small && !(ratio < 1 && steps_ >= kEnough) && steps_ < kMost) {
    term_.swap(next_);
    return false;
  }
  for (std::size_t i = 0; i < next_.size(); ++i)
    if (next_[i] > 0) sum_[i] += rest * next_[i];
  return true;
}

}  // namespace flatlight
