// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_RAY_TRACING_RAY_TREE_H_
#define FLATLIGHT_CORE_PLANE_RAY_TRACING_RAY_TREE_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/plane/chains/chain_lights.h"
#include "core/plane/materials/scattering.h"
#include "core/plane/path_tracing/light_sampler.h"
#include "core/plane/path_tracing/vertex.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

struct RayTreeOptions {
  std::optional<std::uint32_t> max_bounces;  // Reflections between emitter and receiver. Absent: all.
  bool end_black_paths = false;              // Changes no result: nothing goes on from a black curve.
};

// Irradiance of Lambertian curves that some method has found before, so that trees of rays can end there.
class KnownIrradiance {
 public:
  virtual ~KnownIrradiance() = default;
  // On one side of an element; of light that was reflected and refracted at most `bounces` times. Normalised. Safe to
  // call from several threads.
  virtual Spectrum At(const SurfacePoint& on_element, Side side, std::uint32_t bounces) const = 0;
};

enum class Emission : std::uint8_t { kSeen, kLeftOut };

// Radiance by branching Monte Carlo (Jarosz et al. 2012): where a ray arrives on a curve, several go on, stratified
// over the hemicircle, each of them in turn with fewer; single ones play roulette. Emitters are found by the rays that
// meet them. All that is random is a pure function of a key.
class RayTree {
 public:
  RayTree(std::shared_ptr<const RayCaster> caster, const RayTreeOptions& options);

  // The same, but of each tree what grows from Lambertian curves is `known`, which must outlive it: rays go on from the
  // others alone. With emission left out it tells what `known`, which may then be a difference, makes of its own.
  RayTree EndedBy(const KnownIrradiance& known, Emission emission = Emission::kSeen) const;

  // Rays that leave a place to which one of `rays` came: their square root, so that the noise of what a ray brings is
  // of the order of what its neighbours leave out. At least 1.
  static std::uint32_t Branches(std::uint32_t rays);

  // What comes along a ray from a receiver that meets a curve at `hit`; if it is one of `rays`. Adds to the rays cast.
  // Of no use if cancelled.
  Spectrum Radiance(const Hit& hit, Vector2 direction, std::uint32_t rays, std::uint64_t key,
                    const Cancellation& cancellation, double& cast) const;

  Emission emission() const { return emission_; }
  // What comes along rays that meet nothing.
  Spectrum Sky() const { return emission_ == Emission::kSeen ? scene_.environment() : Spectrum{}; }

  const RayCaster& caster() const { return *caster_; }
  // Of lights without a surface, over mirrors and glass.
  const ChainLights& chains() const { return *chains_; }
  std::uint32_t most_bounces() const { return most_bounces_; }

 private:
  struct Surface {
    Spectrum reflectance;
    Spectrum front_radiance;
    Spectrum back_radiance;
    std::optional<Scattering> front, back;  // Absent: Lambertian.
  };
  // One growing tree.
  struct Growth {
    const Cancellation& cancellation;
    double& cast;
  };
  // A ray's end. `lossless`: vertices in a row that absorb nothing.
  Spectrum Arriving(const Hit& hit, Vector2 direction, std::uint32_t depth, std::uint32_t branches, int lossless,
                    std::uint64_t key, const Growth& growth) const;
  Spectrum Leaving(const Vertex& vertex, double sine, double cosine, std::uint32_t depth, std::uint32_t branches,
                   int lossless, std::uint64_t key, const Growth& growth) const;
  // Calls visit(IncidentLight) for light of lights without a surface, weighed such that the sum has the right mean.
  template <typename Visit>
  void VisitLights(const Vertex& vertex, std::uint32_t depth, std::uint64_t key, const Growth& growth,
                   Visit visit) const;
  Spectrum Diffuse(const Vertex& vertex, const Spectrum& reflectance, std::uint32_t depth, std::uint32_t branches,
                   std::uint64_t key, const Growth& growth) const;
  Spectrum Scattered(const Vertex& vertex, const Scattering& scattering, LocalDirection out, std::uint32_t depth,
                     std::uint32_t branches, int lossless, std::uint64_t key, const Growth& growth) const;

  std::shared_ptr<const RayCaster> caster_;
  const Scene& scene_;
  bool end_black_paths_;
  std::uint32_t most_bounces_;
  LightSampler lights_;
  std::shared_ptr<const ChainLights> chains_;
  std::shared_ptr<const std::vector<Surface>> surfaces_;  // By curve.
  const KnownIrradiance* known_ = nullptr;
  Emission emission_ = Emission::kSeen;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_RAY_TRACING_RAY_TREE_H_
