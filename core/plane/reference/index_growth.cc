// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/index_growth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <variant>
#include <vector>

#include "core/plane/box.h"

namespace flatlight {
namespace {

// Curves of one glass that hang together by their ends.
struct Body {
  std::vector<Point2> ends;
  Box box;
  double growth = 1;
  bool closed = true;

  bool Touches(const Body& other, double near) const {
    return std::any_of(ends.begin(), ends.end(), [&](Point2 p) { return other.Has(p, near); });
  }
  bool Has(Point2 p, double near) const {
    return std::any_of(ends.begin(), ends.end(), [&](Point2 q) { return Length(p - q) <= near; });
  }
  bool MayHold(const Body& other) const {
    return box.low.x <= other.box.high.x && other.box.low.x <= box.high.x && box.low.y <= other.box.high.y &&
           other.box.low.y <= box.high.y;
  }
};

std::vector<Body> BodiesOf(const Scene& scene) {
  std::vector<Body> bodies;
  // To what curves leave out where others lie on them.
  const double near = 16 * scene.touch_distance() + scene.bezier_distance();
  for (const Curve& curve : scene.curves()) {
    const auto* glass = std::get_if<Dielectric>(&curve.material);
    if (glass == nullptr || curve.element_count == 0) continue;
    Body body;
    body.growth = std::max(glass->ior, 1 / glass->ior);
    for (std::uint32_t i = curve.first_element; i < curve.first_element + curve.element_count; ++i) {
      const Element& element = scene.elements()[i];
      body.box.Add(BoxOf(element, near));
      body.ends.push_back(element.a), body.ends.push_back(element.b);
    }
    // What it hangs together with becomes a part of it.
    for (std::size_t i = 0; i < bodies.size();) {
      if (bodies[i].growth != body.growth || !bodies[i].Touches(body, near)) {
        ++i;
        continue;
      }
      body.box.Add(bodies[i].box);
      body.ends.insert(body.ends.end(), bodies[i].ends.begin(), bodies[i].ends.end());
      bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(i));
    }
    bodies.push_back(std::move(body));
  }
  for (Body& body : bodies) {
    for (std::size_t i = 0; i < body.ends.size() && body.closed; ++i) {
      body.closed = false;
      for (std::size_t k = 0; k < body.ends.size() && !body.closed; ++k)
        body.closed = k != i && Length(body.ends[i] - body.ends[k]) <= near;
    }
  }
  return bodies;
}

}  // namespace

double IndexGrowth(const Scene& scene) {
  const std::vector<Body> bodies = BodiesOf(scene);
  double everywhere = 1, inside = 1;
  for (const Body& body : bodies) {
    if (!body.closed) {
      everywhere *= body.growth;
      continue;
    }
    double here = 1;
    for (const Body& other : bodies)
      if (other.closed && body.MayHold(other)) here *= other.growth;
    inside = std::max(inside, here);
  }
  return everywhere * inside;
}

Spectrum GlowGrowth(const Scene& scene) {
  Spectrum growth = Spectrum::Grey(1);
  for (const Curve& curve : scene.curves()) {
    if (!IsSpecular(curve.material) || !curve.Emits()) continue;
    for (int c = 0; c < kMaxChannels; ++c) {
      const bool fades = curve.reflectance[c] < 1 && !std::holds_alternative<Dielectric>(curve.material);
      growth[c] = fades ? std::max(growth[c], 1 / (1 - curve.reflectance[c])) : std::numeric_limits<double>::infinity();
    }
  }
  return growth;
}

}  // namespace flatlight
