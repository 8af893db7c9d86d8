// SPDX-License-Identifier: Apache-2.0
#include "core/cache/record_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/cache/series_rest.h"
#include "core/math/check.h"

namespace flatlight {
namespace {

// Weights of value and derivatives, each times its power of the width and over its factorial, of the end at which the
// fraction t is 0.
std::array<double, kRecordOrders> EndWeights(std::size_t degree, double t) {
  const double s = 1 - t;
  double fall = s;  // (1 - t)^(degree + 1)
  for (std::size_t k = 0; k < degree; ++k) fall *= s;
  std::array<double, kRecordOrders> partial{};  // Sums of binomial(degree + j, j) t^j.
  double term = 1, sum = 0;
  for (std::size_t j = 0; j <= degree; ++j) {
    sum += term;
    partial[j] = sum;
    term *= t * static_cast<double>(degree + j + 1) / static_cast<double>(j + 1);
  }
  std::array<double, kRecordOrders> weights{};
  double power = fall;
  for (std::size_t k = 0; k <= degree; ++k) {
    weights[k] = power * partial[degree - k];
    power *= t / static_cast<double>(k + 1);
  }
  return weights;
}

}  // namespace

bool RecordPair::Joins(const CacheRecord& left, const CacheRecord& right) {
  return left.goes_on && right.goes_on && left.at < right.at && left.at + left.EventToRight() > right.at;
}

RecordPair::RecordPair(const CacheRecord& left, const CacheRecord& right, std::size_t degree)
    : left_(left), right_(right), degree_(degree), width_(right.at - left.at) {
  FLATLIGHT_DCHECK(degree < left.known && degree < right.known);
  for (const VisibilityEvent& event : EventsIn(left.events, left.at, right.at))
    jumps_.push_back({&event, kRecordOrders});
  Smooth();
  for (Jump& jump : jumps_) {
    // Where its terms grow, the last of them may do more harm than good.
    const std::size_t orders = jump.event->OrdersOver(right.at - jump.event->at);
    if (orders == kRecordOrders) continue;
    const double with_all = SmoothErrorAt(0.5);
    jump.orders = orders;
    Smooth();
    if (SmoothErrorAt(0.5) < with_all) continue;
    jump.orders = kRecordOrders;
    Smooth();
  }
  if (changes_ == 0) return;
  for (const Jump& jump : jumps_) {
    const VisibilityEvent& event = *jump.event;
    if (!event.before || !IsLastInPlace(left.events, event) || event.at >= right.at) continue;
    const double off = (At(event.at) - *event.before - event.jump[0]).MaxSize();
    // Something that no event tells.
    if (off > kAsExpected * SmoothErrorAt(Fraction(event.at))) doubts_.push_back({event.at, off});
  }
}

Spectrum RecordPair::Polynomial(std::size_t degree, double fraction) const {
  const std::array<double, kRecordOrders> left = EndWeights(degree, fraction), right = EndWeights(degree, 1 - fraction);
  Spectrum sum;
  double power = 1, signed_power = 1;
  for (std::size_t k = 0; k <= degree; ++k) {
    sum = sum + power * left[k] * left_.derivative[k] + signed_power * right[k] * smooth_right_[k];
    power *= width_;
    signed_power *= -width_;
  }
  return sum;
}

Spectrum RecordPair::At(double place) const {
  Spectrum sum = Polynomial(degree_, Fraction(place));
  for (const Jump& jump : jumps_) {
    if (jump.event->at > place) break;
    sum = sum + jump.event->Derivative(0, place - jump.event->at, jump.orders);
  }
  return sum;
}

void RecordPair::Smooth() {
  smooth_right_ = right_.derivative;
  for (const Jump& jump : jumps_) {
    const double beyond = right_.at - jump.event->at;
    for (std::size_t k = 0; k < jump.orders; ++k)
      smooth_right_[k] = smooth_right_[k] - jump.event->Derivative(k, beyond, jump.orders);
  }
  changes_ = 0;
  const std::size_t known = std::min(left_.known, right_.known);
  for (std::size_t order = degree_ + 1; order < known && changes_ < change_.size(); ++order) {
    // What one more derivative changes is (t (1 - t))^order times a linear function.
    double over = 1;
    for (std::size_t k = 0; k < order; ++k) over *= 16.0 / 3;
    const auto linear = [&](double t) { return over * (Polynomial(order, t) - Polynomial(order - 1, t)); };
    const Spectrum first = linear(0.25), last = linear(0.75);
    change_[changes_++] = std::max((1.5 * first - 0.5 * last).MaxSize(), (1.5 * last - 0.5 * first).MaxSize());
  }
}

double RecordPair::LeftShare(double place) const { return EndWeights(degree_, Fraction(place))[0]; }

double RecordPair::SmoothErrorAt(double fraction) const {
  const double both = fraction * (1 - fraction);
  double power = both;
  for (std::size_t k = 0; k < degree_; ++k) power *= both;
  const double first = change_[0] * power, second = change_[1] * power * both;
  if (changes_ == 1 || second == 0) return first + second;
  return first + second / (1 - SeriesRatio(first, second));
}

double RecordPair::ErrorAt(double place) const {
  // No more is known than what extrapolates.
  if (changes_ == 0) return std::min(left_.scale * left_.ErrorAt(place), right_.scale * right_.ErrorAt(place));
  double error = SmoothErrorAt(Fraction(place));
  for (const Doubt& doubt : doubts_) {
    const double share =
        place < doubt.at ? (place - left_.at) / (doubt.at - left_.at) : (right_.at - place) / (right_.at - doubt.at);
    error = std::max(error, share * doubt.off);
  }
  return error;
}

double RecordPair::CostAt(double place) const {
  const double error = ErrorAt(place);
  const double scale = left_.least > 0 ? std::max(At(place).Max(), left_.least) : left_.scale;
  return error == 0 ? 0 : scale > 0 ? error / scale : std::numeric_limits<double>::infinity();
}

}  // namespace flatlight
