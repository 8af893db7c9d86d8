// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_BEAM_MAKER_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_BEAM_MAKER_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "core/plane/chains/beam.h"
#include "core/plane/ray_caster.h"

namespace flatlight {

// Finds the ways of light without a surface over mirrors and glass. What a beam meets changes only where a ray of it
// passes an end of a piece, touches an arc or goes through a point that two pieces have in common: all these are roots
// of the beam's offsets, so that nothing is missed, however small. Safe to use from several threads.
class BeamMaker {
 public:
  // Which must outlive this.
  explicit BeamMaker(const RayCaster& caster);

  // Mirrors and glass: pieces.
  std::size_t turning_pieces() const { return turning_.size(); }
  // Beams behind one mirror or border. Adds to the rays cast.
  std::vector<Beam> FirstBeams(double& rays) const;
  // Those behind one more. Adds to the rays cast.
  std::vector<Beam> Grow(const Beam& beam, double& rays) const;

 private:
  // Rays that come to the last link of a chain, if nothing blocks them: what is left is cut into beams.
  struct Approach {
    Chain chain;
    const LineFamily& lines;
  };
  void Meet(const Beam& beam, ElementId target, double& rays, std::vector<Beam>& beams) const;
  void Carve(const Approach& approach, double begin, double end, int cuts, double& rays,
             std::vector<Beam>& beams) const;
  // What stands in the way of the ray `u`.
  ElementId BlockerOf(const Chain& chain, double u, double& rays) const;
  // Of the ray `u` behind the border that is the last link; negative where it is reflected totally.
  std::optional<double> SquaredCosineBehind(const Chain& chain, double u) const;
  void AddBeams(const Chain& chain, double begin, double end, std::vector<Beam>& beams) const;

  const RayCaster& caster_;
  const Scene& scene_;
  std::vector<ElementId> turning_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_BEAM_MAKER_H_
