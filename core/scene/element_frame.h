// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SCENE_ELEMENT_FRAME_H_
#define FLATLIGHT_CORE_SCENE_ELEMENT_FRAME_H_

#include "core/math/vec.h"
#include "core/scene/scene.h"

namespace flatlight {

// A place on an element and the directions there. Normalised coordinates.
struct ElementFrame {
  Point2 position;
  Vector2 tangent;       // Unit, from a to b.
  Vector2 normal;        // Unit, the front.
  double curvature = 0;  // d(tangent)/d(arc length) = curvature * normal.
};

// The place at a fraction in [0, 1] of the element's length.
ElementFrame FrameAt(const Element& element, double fraction);

// The way back: the fraction of the element's length at which a point of it lies, in [0, 1].
double FractionAt(const Element& element, Point2 on_element);

// Unit normal of the front at a point of the element.
Vector2 FrontNormal(const Element& element, Point2 on_element);

// From a point to the nearest point of the element; for arcs to first order, exact near the arc, and nowhere less than
// half of it.
double DistanceTo(const Element& element, Point2 p);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_ELEMENT_FRAME_H_
