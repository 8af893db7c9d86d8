// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_WIDTH_CHOICE_H_
#define FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_WIDTH_CHOICE_H_

#include <array>
#include <cstddef>
#include <vector>

#include "core/statistics/replicates.h"

namespace flatlight {

// The density at one place with kernels of several widths, the widest first, as each replicate tells it.
struct WidthLadder {
  static constexpr double kRatio = 1.6;  // Of one width to the next.

  std::vector<std::array<double, kReplicates>> densities;
  double widest = 0;
  double photon = 0;  // Flux of a photon, as all replicates together have them.
};

struct WidthChoice {
  std::size_t chosen = 0;
  double bias = 0;  // About how far the mean with the chosen width is from the truth, no sign.
};

// Chooses the width whose error is least as far as the densities tell: narrow where light changes, wide where it does
// not, and narrower with more photons. Noise is told by the spread of replicates. Bias shows in what differs from
// narrower kernels, but of one place that is mostly their noise. So the mean square of differences beyond noise over
// all places of a curve is what any place has to expect, and what its own differences say counts by how little noise
// they have (empirical Bayes: Efron and Morris 1973, "Stein's estimation rule and its competitors").
class WidthChooser {
 public:
  // Of places that are alike, before any is chosen for. All have as many widths, and each is as many times as wide.
  void Add(const WidthLadder& ladder);
  // For one of them.
  WidthChoice Choose(const WidthLadder& ladder) const;

 private:
  // The bias of other widths is looked for in this many narrower ones.
  static constexpr std::size_t kReach = 5;

  // Sums over places: squares of differences between a width and the narrower ones in reach, less their noise.
  std::vector<std::array<double, kReach>> beyond_noise_;
  double places_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_WIDTH_CHOICE_H_
