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

// The width whose error is least as far as the densities tell: noise by the spread of replicates, bias by what differs
// from narrower ones beyond the noise of both (Goldenshluger and Lepski 2011, "Bandwidth selection in kernel density
// estimation"). Narrow where light changes, wide where it does not, and narrower with more photons.
WidthChoice ChooseWidth(const WidthLadder& ladder);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PHOTON_MAPPING_WIDTH_CHOICE_H_
