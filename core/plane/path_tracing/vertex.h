// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_PATH_TRACING_VERTEX_H_
#define FLATLIGHT_CORE_PLANE_PATH_TRACING_VERTEX_H_

#include <cmath>
#include <cstdint>

#include "core/math/vec.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// A place where a path arrives, seen from the side that receives. Directions are told by their sine: that of the angle
// from the normal toward the tangent (normal.y, -normal.x).
struct Vertex {
  static constexpr std::uint32_t kNoCarrier = 0xffffffff;

  SurfacePoint at;
  Vector2 normal;
  std::uint32_t carrier = kNoCarrier;  // Of the piece it lies on.

  Vector2 Tangent() const { return Right(normal); }
  Vector2 Direction(double sine, double cosine) const { return sine * Tangent() + cosine * normal; }
};

inline Vertex VertexAt(const Scene& scene, const Receiver& receiver) {
  Vertex vertex;
  vertex.at = {receiver.position, receiver.element};
  vertex.normal = receiver.normal;
  if (receiver.element != ElementId::kNone) vertex.carrier = scene.element(receiver.element).carrier;
  return vertex;
}

// The non-negative cosine of an angle of known sine.
inline double CosineOf(double sine) { return std::sqrt((1 - sine) * (1 + sine)); }

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_PATH_TRACING_VERTEX_H_
