// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/accumulation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace flatlight {

Accumulation::Accumulation(Values source, std::optional<std::uint32_t> bounces, Values start, Values weights,
                           double tolerance, double rounding)
    : rounding_(rounding) {
  if (!bounces) {
    minimiser_.emplace(std::move(source), std::move(start), tolerance, std::move(weights));
    return;
  }
  before_.assign(source.size(), 0.0);
  values_ = *bounces > 0 ? source : before_;
  bounces_ = *bounces > 0 ? *bounces - 1 : 0;
  source_ = std::move(source);
}

bool Accumulation::Step(const LinearMap& transport) {
  if (minimiser_) {
    return minimiser_->Step([&](const Values& in, Values& out) {
      transport(in, out);
      for (std::size_t i = 0; i < in.size(); ++i) out[i] = in[i] - out[i];
    });
  }
  if (bounces_ == 0) return true;
  --bounces_;
  before_.swap(values_);
  transport(before_, values_);
  double change = 0, most = 0;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    values_[i] += source_[i];
    change = std::max(change, std::abs(values_[i] - before_[i]));
    most = std::max(most, std::abs(values_[i]));
  }
  // What further bounces add is of the size of their rounding.
  return bounces_ == 0 || change <= rounding_ * most;
}

}  // namespace flatlight
