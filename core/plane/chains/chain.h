// SPDX-License-Identifier: Apache-2.0
// The way of light from a light without a surface over mirrors and through glass, one after the other. A point of the
// first of these curves decides all that follows.
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "core/plane/chains/chain_link.h"
#include "core/plane/chains/ray_series.h"
#include "core/plane/ray_caster.h"
#include "core/scene/light.h"
#include "core/scene/scene.h"

namespace flatlight {

struct Chain {
  const Light* light = nullptr;
  std::vector<ChainLink> links;  // At least one.
};

// What comes over a chain.
template <std::size_t n>
struct ChainRays {
  RaySeries<n> ray;  // Behind the last link.
  // Over a change du of the fraction of the first link's length, `flux` du times `colour`: of the light's intensity, or
  // irradiance, and of mirrors' reflectance. Not negative. Known to n - 1 terms.
  Series<n> flux;
  Spectrum colour;
};

// Reflection on a link's curve, at the place from which the rays start, or passage through it. Returns false where they
// should cross and are totally reflected.
template <std::size_t n>
bool TurnAt(const Scene& scene, const ChainLink& link, ChainRays<n>& rays);

// Light by way of the place u of the first link, behind the last one. Absent if a ray misses a link's line or circle,
// or is totally reflected where it should cross. `places`: filled with where it meets the links; may be null.
// Made for n = 2 and 4.
template <std::size_t n>
std::optional<ChainRays<n>> FollowChain(const Scene& scene, const Chain& chain, double u,
                                        std::vector<SurfacePoint>* places);

// The same before the last link: what comes to it, or to its line or circle.
template <std::size_t n>
std::optional<ChainRays<n>> FollowChainToLast(const Scene& scene, const Chain& chain, double u);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_H_
