// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_SORTED_PHOTONS_H_
#define FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_SORTED_PHOTONS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/plane/photon_mapping/kernel.h"
#include "core/plane/photon_mapping/photon_tracer.h"
#include "core/plane/photon_mapping/stretches.h"

namespace flatlight {

// Where the photons of one side lie in an array that is sorted by side, then by arc length.
class SideRanges {
 public:
  // Sides come in increasing order.
  void Append(SideId side, std::size_t index);
  void End(std::size_t count) { ends_ = count; }
  const std::vector<SideId>& sides() const { return sides_; }  // That have photons.
  // The place of a side among these; absent if it has none.
  std::optional<std::size_t> Find(SideId side) const;
  // [first, last), empty if the side has none.
  std::pair<std::size_t, std::size_t> Of(SideId side) const;

 private:
  std::vector<SideId> sides_;
  std::vector<std::size_t> begins_;
  std::size_t ends_ = 0;
};

// The photons of one replicate by side and arc length. What a box kernel finds takes two binary searches, for sums over
// all photons before each are kept.
class SortedPhotons {
 public:
  explicit SortedPhotons(std::vector<Photon> photons);

  std::size_t size() const { return photons_.size(); }
  const Photon& operator[](std::size_t i) const { return photons_[i]; }

  // The sum over the photons of `place.side` whose path was reflected at most `bounces` times and whose offset along
  // the curve is smaller than `width`: flux times kernel, per length. `period`: of a closed stretch, its length; else
  // 0.
  Spectrum Density(const SidePlace& place, double width, double period, const EndedKernel& kernel,
                   std::uint32_t bounces) const;

 private:
  Spectrum RangeDensity(std::size_t first, std::size_t last, double at, double width, const EndedKernel& kernel,
                        std::uint32_t bounces) const;

  std::vector<Photon> photons_;
  SideRanges ranges_;
  std::vector<Spectrum> flux_before_;    // Of the photons before each; one more for the end.
  std::vector<Spectrum> moment_before_;  // The same, times arc length.
  std::uint32_t deepest_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_SORTED_PHOTONS_H_
