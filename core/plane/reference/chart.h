// SPDX-License-Identifier: Apache-2.0
// Places on an element by a number from 0 (its end a) to 1 (its end b).
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_CHART_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_CHART_H_

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// A segment's fraction of its length; an arc's fraction of the tangent of half its angle, which makes its points
// rational functions of the number.
class Chart {
 public:
  explicit Chart(const Element& element);

  struct Place {
    Point2 position;
    Vector2 tangent;   // Unit, from a to b.
    double speed = 0;  // Arc length per unit of the number.
  };
  Place At(double u) const;
  // The number of a point near the element; beyond its ends below 0 or above 1.
  double Find(Point2 point) const;
  // How far a point is from a stretch of the element, for functions of its distance: they are analytic within an
  // ellipse around [low, high] in the plane of complex numbers. The sum of its distances to both ends over their
  // distance.
  double Roundness(Point2 x, double low, double high) const;
  // In the direction of the element, from a to b: d(tangent)/d(arc length) = curvature * front normal.
  double curvature() const { return curvature_; }
  // Of arcs: tangent of half the angle from a to b, by which places are numbered.
  double half_tangent() const { return half_tangent_; }

  // The point there as a receiver that looks to one of the sides; its arc length is not set.
  Receiver ReceiverAt(ElementId id, double u, Side side) const;

 private:
  const Element* element_;
  Vector2 along_;            // Segments: from a to b.
  double half_tangent_ = 0;  // Arcs: of the whole sweep, signed.
  double curvature_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_CHART_H_
