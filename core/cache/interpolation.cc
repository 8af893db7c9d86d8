// SPDX-License-Identifier: Apache-2.0
#include "core/cache/interpolation.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace flatlight {
namespace {

// Relative to irradiance: what is less counts as no error.
constexpr double kLeastError = 1e-12;

}  // namespace

Weighting WeightingOf(ErrorControl control) {
  return control == ErrorControl::kVisibilityEvents ? Weighting::kError : Weighting::kDistance;
}

TrackInterpolation::TrackInterpolation(std::vector<const CacheRecord*> records, std::size_t degree, Weighting weighting)
    : records_(std::move(records)), degree_(degree), weighting_(weighting) {
  std::stable_sort(records_.begin(), records_.end(), [](const auto* a, const auto* b) { return a->at < b->at; });
  for (const CacheRecord* record : records_) {
    const double reach = record->at + record->right_radius;
    reach_.push_back(reach_.empty() ? reach : std::max(reach_.back(), reach));
    left_reach_ = std::max(left_reach_, record->left_radius);
  }
  pairs_.resize(records_.size());
  for (std::size_t i = 1; i < records_.size(); ++i)
    if (RecordPair::Joins(*records_[i - 1], *records_[i]))
      pairs_[i - 1].emplace(*records_[i - 1], *records_[i], degree_);
}

Interpolated TrackInterpolation::At(double place) const {
  Interpolated sum;
  double weights = 0;
  const auto add = [&](const CacheRecord& record) {
    const double distance = place < record.at ? record.at - place : place - record.at;
    const double radius = place < record.at ? record.left_radius : record.right_radius;
    if (!(distance < radius || distance == 0)) return;
    const double error = record.scale * record.ErrorAt(place);
    double weight = distance == 0 ? 1 : 1 - distance / radius;
    if (weighting_ == Weighting::kError)
      weight /= error + kLeastError * record.scale + std::numeric_limits<double>::min();
    weights += weight;
    sum.irradiance = sum.irradiance + weight * Extrapolate(record, place, degree_);
    sum.error += weight * (record.noise + error);
    ++sum.records;
  };
  const auto after = std::upper_bound(records_.begin(), records_.end(), place,
                                      [](double x, const CacheRecord* record) { return x < record->at; });
  if (after != records_.begin() && after != records_.end()) {
    const auto left = std::prev(after);
    if (const std::optional<RecordPair>& pair = pairs_[static_cast<std::size_t>(left - records_.begin())]) {
      const double share = pair->LeftShare(place);
      sum.irradiance = pair->At(place);
      for (double& value : sum.irradiance.value) value = std::max(value, 0.0);
      sum.error = pair->ErrorAt(place) + share * (*left)->noise + (1 - share) * (*after)->noise;
      sum.records = place == (*left)->at ? 1 : 2;
      return sum;
    }
  }
  for (std::size_t i = static_cast<std::size_t>(after - records_.begin()); i-- > 0 && reach_[i] >= place;)
    add(*records_[i]);
  for (auto record = after; record != records_.end() && (*record)->at - left_reach_ <= place; ++record) add(**record);
  if (weights > 0) {
    sum.irradiance = (1 / weights) * sum.irradiance;
    sum.error /= weights;
  }
  for (double& value : sum.irradiance.value) value = std::max(value, 0.0);
  return sum;
}

}  // namespace flatlight
