// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/sorted_photons.h"

#include <algorithm>

namespace flatlight {

void SideRanges::Append(SideId side, std::size_t index) {
  if (!sides_.empty() && sides_.back() == side) return;
  sides_.push_back(side);
  begins_.push_back(index);
}

std::optional<std::size_t> SideRanges::Find(SideId side) const {
  const auto found = std::lower_bound(sides_.begin(), sides_.end(), side);
  if (found == sides_.end() || *found != side) return std::nullopt;
  return static_cast<std::size_t>(found - sides_.begin());
}

std::pair<std::size_t, std::size_t> SideRanges::Of(SideId side) const {
  const std::optional<std::size_t> i = Find(side);
  if (!i) return {0, 0};
  return {begins_[*i], *i + 1 < begins_.size() ? begins_[*i + 1] : ends_};
}

SortedPhotons::SortedPhotons(std::vector<Photon> photons) : photons_(std::move(photons)) {
  std::sort(photons_.begin(), photons_.end(),
            [](const Photon& p, const Photon& q) { return p.side < q.side || (p.side == q.side && p.at < q.at); });
  flux_before_.resize(photons_.size() + 1);
  moment_before_.resize(photons_.size() + 1);
  for (std::size_t i = 0; i < photons_.size(); ++i) {
    const Photon& photon = photons_[i];
    ranges_.Append(photon.side, i);
    flux_before_[i + 1] = flux_before_[i] + photon.flux;
    moment_before_[i + 1] = moment_before_[i] + photon.at * photon.flux;
    deepest_ = std::max(deepest_, photon.depth);
  }
  ranges_.End(photons_.size());
}

Spectrum SortedPhotons::Density(const SidePlace& place, double width, double period, const EndedKernel& kernel,
                                std::uint32_t bounces) const {
  const auto [first, last] = ranges_.Of(place.side);
  if (first == last) return {};
  Spectrum sum = RangeDensity(first, last, place.at, width, kernel, bounces);
  if (period > 0) {
    // The same photons once around.
    if (place.at < width) sum = sum + RangeDensity(first, last, place.at + period, width, kernel, bounces);
    if (place.at > period - width) sum = sum + RangeDensity(first, last, place.at - period, width, kernel, bounces);
  }
  return sum;
}

Spectrum SortedPhotons::RangeDensity(std::size_t first, std::size_t last, double at, double width,
                                     const EndedKernel& kernel, std::uint32_t bounces) const {
  const auto begin = photons_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = photons_.begin() + static_cast<std::ptrdiff_t>(last);
  const auto low = std::partition_point(begin, end, [&](const Photon& p) { return at - p.at >= width; });
  const auto high = std::partition_point(low, end, [&](const Photon& p) { return p.at - at < width; });
  if (low == high) return {};
  if (kernel.kernel == Kernel::kBox && bounces >= deepest_) {
    const auto from = static_cast<std::size_t>(low - photons_.begin());
    const auto to = static_cast<std::size_t>(high - photons_.begin());
    const Spectrum flux = flux_before_[to] + -1.0 * flux_before_[from];
    if (kernel.slope == 0) return (kernel.constant * 0.5 / width) * flux;
    const Spectrum moment = moment_before_[to] + -1.0 * moment_before_[from] + -at * flux;
    return (0.5 / width) * (kernel.constant * flux + (kernel.slope / width) * moment);
  }
  Spectrum sum;
  for (auto photon = low; photon != high; ++photon) {
    if (photon->depth <= bounces) sum = sum + (kernel((photon->at - at) / width) / width) * photon->flux;
  }
  return sum;
}

}  // namespace flatlight
