// SPDX-License-Identifier: Apache-2.0
#include "core/plane/box.h"

#include <algorithm>

namespace flatlight {

Box BoxOf(const Element& element, double margin) {
  Box box;
  box.Add(element.a);
  box.Add(element.b);
  if (element.kind == Element::Kind::kArc) {
    // An arc of at most a quarter lies in the triangle of its ends and the point where its end tangents meet, and
    // bulges from the chord by no more than half of it.
    const Vector2 chord = element.b - element.a;
    const Vector2 outward = element.Orientation() * Right(chord);
    const double bulge = 0.5 * Length(chord);
    const Vector2 offset = bulge / Length(chord) * outward;
    const double cos_half = Dot(element.radial_a, Normalized(element.radial_a + element.radial_b));
    const Vector2 sagitta = std::min(bulge, element.radius * (1 - cos_half) * (1 + 1e-9) + 1e-15) / bulge * offset;
    box.Add(element.a + sagitta);
    box.Add(element.b + sagitta);
  }
  return {box.low - Vector2{margin, margin}, box.high + Vector2{margin, margin}};
}

}  // namespace flatlight
