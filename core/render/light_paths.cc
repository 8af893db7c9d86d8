// SPDX-License-Identifier: Apache-2.0
#include "core/render/light_paths.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace flatlight {
namespace {

// NothingBlocks looks at all pairs of pieces: above this number a room is hardly convex and planning must stay quick.
constexpr std::size_t kMostPiecesCompared = 256;
// Sets of points that curves connect.
class Connections {
 public:
  // False if the two were connected before.
  bool Connect(Point2 p, Point2 q) {
    const std::size_t i = Root(IndexOf(p));
    const std::size_t j = Root(IndexOf(q));
    parent_[i] = j;
    return i != j;
  }

 private:
  std::size_t IndexOf(Point2 p) {
    const auto [found, added] = index_.try_emplace({p.x, p.y}, parent_.size());
    if (added) parent_.push_back(parent_.size());
    return found->second;
  }
  std::size_t Root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  std::map<std::pair<double, double>, std::size_t> index_;
  std::vector<std::size_t> parent_;
};

}  // namespace

bool DirectLightOnly(const Scene& scene, const Settings& settings) {
  return settings.max_bounces == 0u || scene.traits().max_reflectance == 0;
}

bool NothingBlocks(const Scene& scene) {
  const std::vector<Element>& elements = scene.elements();
  if (scene.traits().has_arcs || elements.size() > kMostPiecesCompared) return false;
  for (const Element& edge : elements) {
    bool left = false;
    bool right = false;
    const auto look = [&](Point2 p) {
      // Ends shared with the edge give exactly 0. A point closer than rounding counts on both sides, to be certain.
      const double side = Cross(edge.b - edge.a, p - edge.a);
      const bool exact = p == edge.a || p == edge.b;
      const double doubt = exact ? 0 : 4 * scene.coordinate_error() * edge.length;
      left = left || side > -doubt;
      right = right || side < doubt;
    };
    for (const Element& other : elements) {
      if (&other == &edge) continue;
      for (const Point2 end : {other.a, other.b}) {
        if (end == edge.a || end == edge.b) continue;
        look(end);
      }
    }
    for (const Probe& probe : scene.probes()) {
      for (const Receiver& receiver : probe.receivers) {
        if (receiver.element == ElementId::kNone) look(receiver.position);
      }
    }
    if (left && right) return false;
  }
  return true;
}

bool LightNeverFades(const Scene& scene) {
  const std::vector<Curve>& curves = scene.curves();
  if (!std::all_of(curves.begin(), curves.end(), [](const Curve& c) { return c.reflectance.Max() == 1; })) return false;
  Connections connections;
  for (const Element& element : scene.elements()) {
    if (!connections.Connect(element.a, element.b)) return true;
  }
  return false;
}

}  // namespace flatlight
