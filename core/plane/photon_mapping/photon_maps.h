// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_PHOTON_MAPS_H_
#define FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_PHOTON_MAPS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/execution/executor.h"
#include "core/plane/photon_mapping/kernel.h"
#include "core/plane/photon_mapping/photon_tracer.h"
#include "core/plane/photon_mapping/sorted_photons.h"
#include "core/plane/photon_mapping/stretches.h"
#include "core/plane/photon_mapping/width_choice.h"
#include "core/plane/ray_tracing/ray_tree.h"
#include "core/statistics/replicates.h"

namespace flatlight {

// How far photons count.
struct DensityOptions {
  Kernel kernel = Kernel::kEpanechnikov;
  // At most one of these. Neither: what is best by the photons themselves (WidthChooser), at some places of each side.
  std::optional<double> neighbours;  // So many photons that are nearest; at least 2.
  std::optional<double> bandwidth;   // Half the kernel's width; normalised.
  // Of the widths that are chosen: less than 1 where maps before this one have a part in what noise there may be.
  double narrowing = 1;
  bool chooses = true;  // False if every width will be given: see WindowOf.
};

// Where a density is wanted, how wide the kernel is there, and how wide another one that tells the bias of the first.
struct DensityWindow {
  SidePlace place;
  double width = 0;
  double other_width = 0;
  double bias_factor = 0;  // Times the difference, other less first.
  // The photon that sets the width, and therefore is not counted (k photons, of which the last is at the width itself,
  // have a density of k - 1 over the measure, in the mean); replicate kReplicates if there is none.
  std::size_t left_out_replicate = kReplicates;
  std::size_t left_out = 0;
};

// The photons of all replicates of a rendering. Widths are chosen by all of them together, densities are of each alone:
// linear in its photons, so that their spread tells the error.
class PhotonMaps {
 public:
  using Photons = std::array<std::vector<Photon>, kReplicates>;

  // paths[r]: behind photons[r]. Sorts on the executor's threads.
  PhotonMaps(const Stretches& stretches, Photons photons, const std::array<double, kReplicates>& paths,
             const DensityOptions& options, Executor& executor, int max_threads);

  std::size_t size() const { return nearby_.size(); }

  DensityWindow WindowAt(const SidePlace& place) const;
  // The same for a width that is given; `place` is not farther than the widest from any other of its stretch.
  DensityWindow WindowOf(const SidePlace& place, double width) const;
  double Widest(const SidePlace& place) const;

  enum class Width : std::uint8_t { kFirst, kOther };
  // As one replicate tells it, of photons reflected at most `bounces` times. Normalised flux per length.
  Spectrum Density(std::size_t replicate, const DensityWindow& window, Width width, std::uint32_t bounces) const;
  // Density with the first width less the truth, as the two widths tell.
  Spectrum Bias(std::size_t replicate, const DensityWindow& window, std::uint32_t bounces) const;
  const Stretches& stretches() const { return stretches_; }

 private:
  // A photon among those of all replicates.
  struct Nearby {
    SideId side{};
    double at = 0;
    std::uint32_t replicate = 0;
    std::uint32_t index = 0;
  };

  void ChooseWidths(Executor& executor, int max_threads);
  double ChosenWidth(const SidePlace& place) const;
  WidthLadder LadderAt(const SidePlace& place, double photon) const;
  void SetNearest(std::size_t first, std::size_t last, std::size_t count, DensityWindow& window) const;
  EndedKernel KernelAt(const SidePlace& place, double width) const;

  const Stretches& stretches_;
  DensityOptions options_;
  std::array<double, kReplicates> paths_;
  std::vector<SortedPhotons> replicates_;
  std::vector<Nearby> nearby_;  // Sorted like each replicate.
  SideRanges ranges_;
  // Widths chosen at places evenly along the sides that have photons; where those of each begin, and where all end.
  std::vector<double> widths_;
  std::vector<std::size_t> first_width_;
};

// What one replicate's photons tell of irradiance, for trees of rays that end there.
class MapIrradiance final : public KnownIrradiance {
 public:
  enum class Quantity : std::uint8_t { kIrradiance, kBias };
  MapIrradiance(const PhotonMaps& maps, std::size_t replicate, Quantity quantity)
      : maps_(maps), replicate_(replicate), quantity_(quantity) {}

  Spectrum At(const SurfacePoint& on_element, Side side, std::uint32_t bounces) const override;

 private:
  const PhotonMaps& maps_;
  std::size_t replicate_;
  Quantity quantity_;
};

// What the photons of all replicates tell of irradiance together.
class PooledIrradiance final : public KnownIrradiance {
 public:
  // kDoubt: what the irradiance may be off by, the standard error of the replicates and the bias without its sign.
  enum class Quantity : std::uint8_t { kIrradiance, kDoubt };
  PooledIrradiance(const PhotonMaps& maps, Quantity quantity) : maps_(maps), quantity_(quantity) {}

  Spectrum At(const SurfacePoint& on_element, Side side, std::uint32_t bounces) const override;

 private:
  const PhotonMaps& maps_;
  Quantity quantity_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_PHOTON_MAPS_H_
