// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/majorant.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace flatlight {
namespace {

// Of the source, that may be lacking without more ado.
constexpr double kMostLack = 0.1;
// Of the largest bound, by which all may be raised; else they are solved better.
constexpr double kMostRaise = 0.02;
constexpr double kFirstTolerance = 1e-5, kTighter = 1e-3;
constexpr int kMostSolves = 4;
// p - T p is 1 but for what the solver leaves.
constexpr double kUniformTolerance = 1e-4;
constexpr double kLeastKept = 0.25;

}  // namespace

Majorant::Majorant(Values source, Values weights, double reflectance)
    : source_(std::move(source)),
      weights_(std::move(weights)),
      reflectance_(reflectance),
      tolerance_(kFirstTolerance),
      bounds_(source_.size(), 0.0) {}

bool Majorant::Step(const LinearMap& transport) {
  if (!minimiser_) {
    minimiser_.emplace(for_uniform_ ? Values(source_.size(), 1.0) : source_,
                       for_uniform_ ? Values(source_.size(), 1.0) : bounds_,
                       for_uniform_ ? kUniformTolerance : tolerance_, weights_);
  }
  const bool solved = minimiser_->Step([&](const Values& in, Values& out) {
    transport(in, out);
    for (std::size_t i = 0; i < in.size(); ++i) out[i] = in[i] - out[i];
  });
  if (!solved) return false;
  Values& solution = for_uniform_ ? uniform_ : bounds_;
  solution = minimiser_->solution();
  for (double& v : solution) v = std::max(v, 0.0);
  minimiser_.reset();
  if (for_uniform_) {
    for_uniform_ = false;
    LookAtUniform(transport);
  }
  return Look(transport);
}

void Majorant::LookAtUniform(const LinearMap& transport) {
  transport(uniform_, kept_);
  for (std::size_t i = 0; i < kept_.size(); ++i) kept_[i] = uniform_[i] - kept_[i];
  if (*std::min_element(kept_.begin(), kept_.end()) >= kLeastKept) return;
  uniform_.assign(source_.size(), 1.0);
  kept_.assign(source_.size(), std::max(1 - reflectance_, 0.0));
}

bool Majorant::Look(const LinearMap& transport) {
  Values reflected;
  transport(bounds_, reflected);
  double lack = 0, most = 0;
  bool lacks = false;
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const double beyond = source_[i] + reflected[i] - bounds_[i] - kMostLack * source_[i];
    most = std::max(most, bounds_[i]);
    if (!(beyond > 0)) continue;
    lacks = true;
    if (!kept_.empty())
      lack = std::max(lack, kept_[i] > 0 ? beyond / kept_[i] : std::numeric_limits<double>::infinity());
  }
  if (lacks && kept_.empty()) {
    for_uniform_ = true;
    return false;
  }
  const double raise = lacks ? lack * *std::max_element(uniform_.begin(), uniform_.end()) : 0;
  if (raise > kMostRaise * most && ++solves_ < kMostSolves) {
    tolerance_ *= kTighter;
    return false;
  }
  Raise(lack);
  return true;
}

// s + T w - w <= l s + c (p - T p) makes (w + c p) / (1 - l) a bound.
void Majorant::Raise(double lack) {
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    if (source_[i] > 0 || bounds_[i] > 0)
      bounds_[i] = (bounds_[i] + (lack > 0 ? lack * uniform_[i] : 0)) / (1 - kMostLack);
  }
}

}  // namespace flatlight
