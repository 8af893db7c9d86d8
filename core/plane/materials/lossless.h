// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_MATERIALS_LOSSLESS_H_
#define FLATLIGHT_CORE_PLANE_MATERIALS_LOSSLESS_H_

namespace flatlight {

// Light that glass has caught, or that perfect mirrors send to one another, may go around for ever, and none of it is
// absorbed: after so many vertices without loss a path plays roulette all the same.
inline constexpr int kMostLossless = 64;
inline constexpr double kLosslessSurvival = 0.9;

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_MATERIALS_LOSSLESS_H_
