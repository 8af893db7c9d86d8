// SPDX-License-Identifier: Apache-2.0
// What a round has brought, and what the next one is to do.
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/plane/reference/reference_solver.h"
#include "core/plane/reference/refinement.h"

namespace flatlight {
namespace {

constexpr int kMostRounds = 24;
constexpr std::size_t kMostMemory = std::size_t{1} << 30;
// A round that brings the error down by less than this is idle.
constexpr double kIdle = 0.8;
// An error that is larger yet tells nothing: there is no light.
constexpr double kFarthest = 1e6;
// Of the mean of the brightest probe: what is less is all but dark.
constexpr double kDark = 1e-3;
// After a round that brought little equations are solved to so much less.
constexpr double kTighter = 1e-3;

// Of ways that are not followed further, beside the error that is wanted; in one round they are followed no more than
// so much further; and no further than rounding.
constexpr double kUnfollowed = 0.3;
constexpr double kMostFurther = 1e-3;
constexpr double kMuch = 0.2;  // Of those from a point and from panels together.
// So many times as many there may be then: between two mirrors the part of the k-th reflection falls as 1/k^2.
constexpr std::size_t kMoreWays = 32;
constexpr double kLeastShare = 1e-15;

}  // namespace

// What the error of a point is relative to.
double ReferenceSolver::SizeAt(std::size_t i, int c) const {
  return std::max(values_[i].irradiance[c], kFloor * means_[points_.probes[i]][c]);
}

// Where what ways could have brought that were not followed is much of a bound, these are: from the point on, or from
// all panels.
void ReferenceSolver::FollowFurther() {
  std::fill(goes_further_.begin(), goes_further_.end(), 0);
  new_rows_ = false;
  if (!specular_) return;
  double of_rows[kMaxChannels], least_factor = 1;
  for (int c = 0; c < options_.channels; ++c)
    of_rows[c] = world_->radiosity->UnfollowedPart(static_cast<std::size_t>(c));
  const bool rows_may =
      specular_->least_share > kLeastShare && world_->radiosity->memory_of_all() < kMostMemory / kMoreWays;
  for (std::size_t i = 0; i < points_.receivers.size(); ++i) {
    if (dark_waits_ && dark_[i] != 0) continue;
    ViewLimit& limit = limits_[i];
    double factor = 1, factor_of_rows = 1, unfollowed = 0;
    for (int c = 0; c < options_.channels; ++c) {
      const double error = values_[i].irradiance_error[c], allowed = options_.target_error * SizeAt(i, c);
      if (!(error > allowed)) continue;
      const double from_point = limit.unfollowed[c], from_rows = of_rows[c] * limit.indirect[c];
      const double both = from_point + from_rows, wanted = kUnfollowed * std::max(allowed, error - both);
      unfollowed = std::max(unfollowed, from_point);
      if (!(both > 2 * wanted)) continue;
      if (from_point > kMuch * both) factor = std::min(factor, wanted / both);
      if (from_rows > kMuch * both) factor_of_rows = std::min(factor_of_rows, wanted / both);
    }
    if (factor < 1 && limit.least_share > kLeastShare && unfollowed < kIdle * limit.before) {
      limit.before = unfollowed;
      if (limit.sight) sight_bytes_ -= limit.sight->bytes();
      limit.sight.reset();
      limit.least_share = std::max(limit.least_share * std::max(factor, kMostFurther), kLeastShare);
      goes_further_[i] = 1;
    }
    if (factor_of_rows < 1 && rows_may) goes_further_[i] = 1;
    least_factor = std::min(least_factor, factor_of_rows);
  }
  if (!(least_factor < 1) || !rows_may) return;
  specular_->least_share = std::max(specular_->least_share * std::max(least_factor, kMostFurther), kLeastShare);
  new_rows_ = true;
}

void ReferenceSolver::EndPoints() {
  means_ = points_.Means(coming_);
  double brightest = 0;
  for (const Spectrum& mean : means_) brightest = std::max({brightest, mean[0], mean[1], mean[2]});
  values_.swap(coming_);
  FollowFurther();
  relative_error_ = 0;
  double to_improve = 0, of_dark = 0;  // The largest of points that still improve.
  for (std::size_t i = 0; i < points_.receivers.size(); ++i) {
    double relative = 0;
    dark_[i] = 1;
    for (int c = 0; c < options_.channels; ++c) {
      const double size = SizeAt(i, c);
      relative = std::max(relative, Relative(values_[i].irradiance_error[c], size));
      if (size > kDark * kFloor * brightest) dark_[i] = 0;
    }
    relative_error_ = std::max(relative_error_, relative);
    if (rounds_ > 0 && relative > options_.target_error) {
      const bool improves = relative <= kIdle * relative_before_[i] || goes_further_[i] != 0;
      if (improves) {
        idle_rounds_[i] = 0;
      } else if (idle_rounds_[i] < kMostIdleRounds) {
        ++idle_rounds_[i];
      }
    }
    relative_before_[i] = relative;
    double& most = dark_[i] != 0 ? of_dark : to_improve;
    if (idle_rounds_[i] < kMostIdleRounds) most = std::max(most, relative);
  }
  dark_waits_ = to_improve > options_.target_error;
  if (!dark_waits_) to_improve = std::max(to_improve, of_dark);
  if (rounds_++ == 0) first_relative_error_ = relative_error_;
  if (relative_error_ <= options_.target_error) {
    state_ = State::kReached;
    return;
  }
  // It may be the solver's own.
  if (rounds_ > 1 && to_improve > kIdle * to_improve_)
    coarse_tolerance_ = tolerance_ = std::max(kTighter * tolerance_, kLeastTolerance);
  else
    coarse_tolerance_ = std::max(tolerance_, std::min(coarse_tolerance_, kTolerance * relative_error_));
  to_improve_ = to_improve;
  if (rounds_ == kMostRounds || to_improve <= options_.target_error) {
    state_ = State::kExhausted;
    return;
  }
  to_improve = std::min(to_improve, kFarthest);
  std::vector<double> importance(panels(), 0.0);
  CollectShares(importance);
  // Beside what panels add straight away there is what they add by way of others.
  const std::vector<double> influence = world_->radiosity->Influence(std::move(importance));
  double all = 0;
  for (std::size_t i = 0; i < panels(); ++i) all += shares_[i] += influence[i];
  // The largest of many points come to more than any point has.
  const double part = all > 0 ? std::min(1.0, to_improve / options_.target_error / all) : 0;
  for (double& share : shares_) share *= part;
  split_ = PanelsToSplit(shares_);
  const auto splits = static_cast<double>(std::count(split_.begin(), split_.end(), 1));
  const double growth = 1 + splits / static_cast<double>(panels());
  const bool goes_further = std::find(goes_further_.begin(), goes_further_.end(), 1) != goes_further_.end();
  if ((splits == 0 && !goes_further) ||
      growth * growth * static_cast<double>(world_->radiosity->memory_of_all()) > kMostMemory) {
    state_ = State::kExhausted;
    return;
  }
  if (new_rows_) world_->radiosity->DropRows();
  step_ = Step::kSplit;
}

}  // namespace flatlight
