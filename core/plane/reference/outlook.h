// SPDX-License-Identifier: Apache-2.0
// What a receiver sees, piece by piece, each with the place on its element.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_OUTLOOK_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_OUTLOOK_H_

#include <vector>

#include "core/plane/exact/edge.h"
#include "core/plane/exact/gather.h"
#include "core/plane/exact/light_solver.h"
#include "core/plane/exact/sweep.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/chart.h"
#include "core/scene/scene.h"

namespace flatlight {

// An end of a visible piece.
struct PieceEnd {
  Edge edge;         // What ends it: its own end, or the near edge before it.
  double u = 0;      // Where on the element (Chart), in [0, 1].
  bool own = false;  // Nothing hides what is beyond: the element ends here.
};

struct VisiblePiece {
  ElementId element = ElementId::kNone;
  Side side = Side::kFront;  // Which is seen.
  PieceEnd begin;            // In the order of theta.
  PieceEnd end;
  double extent = 0;       // Difference of the sines, >= 0.
  bool after_sky = false;  // Nothing is seen before it.
};

// Holds working memory: one for each thread.
class Outlook {
 public:
  // `charts`: by element. Both must outlive this.
  Outlook(const RayCaster& caster, const std::vector<Chart>& charts)
      : caster_(caster),
        scene_(caster.scene()),
        charts_(charts),
        gatherer_(scene_, caster.bvh()),
        sweep_(scene_),
        lights_(caster, {.derivatives = 0}) {}

  // In the order of theta. Valid until the next call.
  const std::vector<VisiblePiece>& From(const Receiver& receiver);
  // Irradiance straight from emitters, lights and the environment at the receiver of the last call.
  Spectrum Direct(const Receiver& receiver) const;

 private:
  void Add(const Receiver& receiver, ElementId element, Side side, const Part* part, const Edge& begin, const Edge& end,
           bool after_sky);
  PieceEnd Locate(const Receiver& receiver, ElementId element, const Part* part, const Edge& edge) const;

  const RayCaster& caster_;
  const Scene& scene_;
  const std::vector<Chart>& charts_;
  Gatherer gatherer_;
  Sweep sweep_;
  LightSolver lights_;
  std::vector<VisiblePiece> pieces_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_OUTLOOK_H_
