// SPDX-License-Identifier: Apache-2.0
// Where the light at a receiver comes from: quadrature over all that it sees.
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_INCOMING_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_INCOMING_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/plane/glossy/cell_mesh.h"
#include "core/plane/materials/local_direction.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/outlook.h"
#include "core/plane/reference/stretch.h"
#include "core/scene/scene.h"

namespace flatlight {

struct IncomingRay {
  static constexpr std::uint32_t kNoCell = 0xffffffff;
  std::uint32_t cell = kNoCell;
  double x = 0, y = 0;                // In the cell: place and direction, each in [-1, 1].
  double weight = 0;                  // rad.
  LocalDirection in;                  // From the receiver on.
  const Spectrum* emitted = nullptr;  // Null: nothing is.
};

// Rays at the points of a Gauss rule in a number that tells directions: the place on an element (Chart), or the angle
// in radians.
struct IncomingStretch {
  std::size_t first = 0, count = 0;
  ElementId element = ElementId::kNone;  // kNone: the number is the angle.
  Side side = Side::kFront;
  double low = 0, high = 1;
  double radius = 0;  // Of the circle that both the receiver and the element lie on, inside; else 0.
  double turn = 0;    // Then: to which side, -1 or 1, the circle runs on to the receiver itself, if it does there.
  LocalDirection at_low, at_high;
};

// A direction, and how fast it turns with the number of a stretch.
struct TurningRay {
  LocalDirection in;
  double slope = 0;         // rad, >= 0.
  double half_tangent = 0;  // Of the direction in which light leaves toward the receiver.
};

// Holds working memory: one for each thread. The caster and the charts must outlive it.
class Incoming {
 public:
  // Integrals are right to about so many decimal digits.
  Incoming(const RayCaster& caster, const std::vector<Chart>& charts, int digits);

  // What reflects; `emission`: what emits, and the sky, too. Stretches are at most `widest` rad wide.
  void From(const Receiver& receiver, const CellMesh& mesh, bool emission, double widest);
  // Of the last call.
  const std::vector<IncomingRay>& rays() const { return rays_; }
  const std::vector<IncomingStretch>& stretches() const { return stretches_; }
  const std::vector<VisiblePiece>& pieces() const { return *pieces_; }
  TurningRay RayAt(const IncomingStretch& stretch, double number) const;
  // As Outlook::Direct.
  Spectrum Direct() const { return outlook_.Direct(receiver_); }

  // Lights without a surface, as far as they are seen from the receiver of the last call.
  struct Beam {
    LocalDirection in;
    Spectrum irradiance;
  };
  std::vector<Beam> Beams() const;

 private:
  TurningRay RayTo(const IncomingStretch& stretch, double u) const;
  void AddPanel(const VisiblePiece& piece, std::size_t panel, double from, double to);
  void AddStretch(const VisiblePiece& piece, std::uint32_t cell, double from, double to, int depth);
  // What is left of a piece that ends at the receiver.
  void AddEnd(const VisiblePiece& piece, std::uint32_t cell, double from, double to);
  void SetPlace(std::uint32_t cell, double u, double half_tangent, IncomingRay& ray) const;
  // Calls add(ray) for rays between two angles.
  template <typename Add>
  void AddAngles(double from, double to, const Add& add);
  // What the piece is seen as from `low` to `high` of its chart.
  IncomingStretch StretchOf(const VisiblePiece& piece, double low, double high) const;
  void AddSky(double from, double to);

  const RayCaster& caster_;
  const Scene& scene_;
  const std::vector<Chart>& charts_;
  PointCount count_;
  Outlook outlook_;
  Receiver receiver_;
  const CellMesh* mesh_ = nullptr;
  double widest_ = 0, cosine_of_widest_ = 0;
  double radius_ = 0;                  // Of the piece that is being added, as in IncomingStretch.
  const Spectrum* emitted_ = nullptr;  // The same.
  const std::vector<VisiblePiece>* pieces_ = nullptr;
  std::vector<IncomingRay> rays_;
  std::vector<IncomingStretch> stretches_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_INCOMING_H_
