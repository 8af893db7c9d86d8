// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_LIGHTS_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_LIGHTS_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/math/series.h"
#include "core/plane/chains/beam.h"
#include "core/plane/chains/beam_maker.h"
#include "core/plane/chains/incident_light.h"
#include "core/plane/chains/line_tree.h"
#include "core/plane/ray_caster.h"

namespace flatlight {

struct ChainedLight {
  IncidentLight light;
  // How it comes: by way of the fraction u of the first link's length. `factor` times what comes there.
  std::shared_ptr<const Chain> chain;
  double u = 0;
  double factor = 1;
};

struct ChainOptions {
  std::uint32_t most_links = std::numeric_limits<std::uint32_t>::max();
  // Beams are followed beforehand as long as they carry this share of all, and there is room, and time for so many
  // looks at a beam and a piece of a mirror or border.
  double least_share = 1e-7;
  std::size_t most_beams = 1 << 12;
  std::size_t most_coarse_beams = 256;  // For ChainEffort::kCoarse.
  std::size_t most_looks = 1 << 20;
};

// How much is found at a place without chance: for one at which light is wanted, from which many samples are drawn, or
// for one of the many that paths come by.
enum class ChainEffort : std::uint8_t { kFine, kCoarse };

// Light that comes to a place from lights without a surface over mirrors and through glass: caustics. No ray from the
// place finds the way back; but in the plane all light behind a chain of mirrors and borders depends on one number, and
// the rays that pass a place are roots in it. Beams are found beforehand, the strongest ones first; at a place the rays
// are found, each with the exact spread of its beam, and looked at for blockers. Of what lies behind the weakest beams
// a single way is tried now and then, weighed by its chance: nothing is left out in the mean.
class ChainLights {
 public:
  // The caster must outlive this. With no links allowed nothing is found.
  ChainLights(const RayCaster& caster, const ChainOptions& options);

  bool empty() const { return beams_.empty(); }
  std::size_t beams() const { return beams_.size(); }
  // What is left to chance, as a share of the light behind one link.
  double chance_share(ChainEffort effort) const { return LevelOf(effort).open_share; }

  // Adds to `found` the light of beams found beforehand that comes to a place on the side of its normal, over at most
  // `most_links` links. Nothing is random. Adds to the rays cast.
  void Find(ChainEffort effort, const SurfacePoint& at, Vector2 normal, std::uint32_t most_links, double& rays,
            std::vector<ChainedLight>& found) const {
    std::vector<Found> all;
    LevelOf(effort).tree.VisitNear(at.position, [&](std::size_t i) {
      if (beams_[i].links() <= most_links) AddFrom(beams_[i], at, normal, rays, all);
    });
    AddOnce(all, 1, found);
  }
  // Adds what has the mean of all other light, by a number in [0, 1): mostly nothing.
  void FindByChance(ChainEffort effort, const SurfacePoint& at, Vector2 normal, std::uint32_t most_links, double u,
                    double& rays, std::vector<ChainedLight>& found) const {
    const Level& level = LevelOf(effort);
    if (u < level.chance) AddByChance(level, at, normal, most_links, u / level.chance, rays, found);
  }

  // Irradiance by one way as the place moves along a receiver, over that at `receiver`, where the way was found: a
  // series in arc length, of three terms.
  Series<4> AlongReceiver(const ChainedLight& way, const Receiver& receiver) const;

 private:
  // A beam that is not followed.
  struct Open {
    std::size_t beam = 0;
    double flux_end = 0;  // Sum of the flux up to and with this one.
  };
  struct Found {
    ChainedLight way;
    bool at_border = false;  // Of its beam: a neighbour may have found it too.
  };
  // Beams up to a number, and what is left to chance behind them.
  struct Level {
    LineTree tree;
    std::vector<Open> open;
    double open_share = 0;
    double chance = 0;  // Of trying a way behind an open beam.
  };
  // The beams behind one that was followed: those from `first` on.
  struct Followers {
    bool known = false;
    std::size_t first = 0;
    std::size_t count = 0;
  };
  const Level& LevelOf(ChainEffort effort) const { return effort == ChainEffort::kFine ? fine_ : coarse_; }
  void Follow();
  Level MakeLevel(std::vector<std::size_t> open, double total) const;
  void AddFrom(const Beam& beam, const SurfacePoint& at, Vector2 normal, double& rays, std::vector<Found>& found) const;
  // `factor` times all that was found, each way once.
  void AddOnce(const std::vector<Found>& all, double factor, std::vector<ChainedLight>& found) const;
  bool SameCurves(const Chain& chain, const Chain& other) const;
  void AddByChance(const Level& level, const SurfacePoint& at, Vector2 normal, std::uint32_t most_links, double u,
                   double& rays, std::vector<ChainedLight>& found) const;
  bool Unblocked(const Chain& chain, const std::vector<SurfacePoint>& places, const SurfacePoint& at,
                 double& rays) const;

  const RayCaster& caster_;
  const Scene& scene_;
  ChainOptions options_;
  BeamMaker maker_;
  std::vector<Beam> beams_;
  std::vector<Followers> followers_;  // By beam.
  Level fine_, coarse_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_CHAIN_LIGHTS_H_
