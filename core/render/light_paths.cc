// SPDX-License-Identifier: Apache-2.0
#include "core/render/light_paths.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace flatlight {
namespace {

// NothingBlocks looks at single free points only as long as it is quick: this many looks at a piece and a point.
constexpr std::size_t kMostLooks = 50'000;
// Pieces that are compared with all others first: in most scenes one of them has something on either side.
constexpr std::size_t kQuickLooks = 8;

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

bool HasEndsOnBothSides(const Element& edge, const std::vector<Element>& elements) {
  bool left = false;
  bool right = false;
  for (const Element& other : elements) {
    for (const Point2 end : {other.a, other.b}) {
      const double side = Cross(edge.b - edge.a, end - edge.a);
      left = left || side > 0;
      right = right || side < 0;
    }
    if (left && right) return true;
  }
  return false;
}

// The convex hull of all ends, counter-clockwise, by the monotone chain (Andrew 1979).
std::vector<Point2> HullOfEnds(const std::vector<Element>& elements) {
  std::vector<Point2> points;
  points.reserve(2 * elements.size());
  for (const Element& element : elements) points.insert(points.end(), {element.a, element.b});
  std::sort(points.begin(), points.end(), [](Point2 p, Point2 q) { return p.x < q.x || (p.x == q.x && p.y < q.y); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Point2> hull;
  const auto add = [&](Point2 p, std::size_t begin) {
    while (hull.size() >= begin + 2 && !(Cross(hull.back() - hull[hull.size() - 2], p - hull.back()) > 0))
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Point2 p : points) add(p, 0);
  const std::size_t upper = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], upper);
  hull.pop_back();
  return hull;
}

}  // namespace

bool AllDark(const Scene& scene) {
  const SceneTraits& traits = scene.traits();
  return traits.emitting_curves == 0 && traits.lights == 0 && !traits.environment;
}

bool DirectLightOnly(const Scene& scene, const Settings& settings) {
  return settings.max_bounces == 0u || scene.traits().max_reflectance == 0;
}

bool HasChainedLight(const Scene& scene) {
  const std::vector<Curve>& curves = scene.curves();
  return scene.traits().lights > 0 && std::any_of(curves.begin(), curves.end(), [](const Curve& curve) {
           return IsSpecular(curve.material) && !curve.reflectance.IsBlack();
         });
}

bool NothingBlocks(const Scene& scene) {
  const std::vector<Element>& elements = scene.elements();
  if (scene.traits().has_arcs) return false;
  if (elements.empty()) return true;
  for (std::size_t i = 0; i < kQuickLooks; ++i) {
    if (HasEndsOnBothSides(elements[i * elements.size() / kQuickLooks], elements)) return false;
  }
  // Where this holds, the pieces are edges of the hull of all ends: each leads from one of its corners to the next.
  const std::vector<Point2> hull = HullOfEnds(elements);
  const std::size_t corners = hull.size();
  std::map<std::pair<double, double>, std::size_t> corner_at;
  for (std::size_t i = 0; i < corners; ++i) corner_at.emplace(std::pair(hull[i].x, hull[i].y), i);
  std::size_t looks_left = kMostLooks;
  for (const Element& edge : elements) {
    const auto found_a = corner_at.find({edge.a.x, edge.a.y});
    const auto found_b = corner_at.find({edge.b.x, edge.b.y});
    if (found_a == corner_at.end() || found_b == corner_at.end()) return false;
    const std::size_t a = found_a->second;
    const std::size_t b = found_b->second;
    const bool forward = (a + 1) % corners == b;
    if (!forward && (b + 1) % corners != a) return false;
    // A point closer than rounding counts on both sides, to be certain.
    const double doubt = 4 * scene.coordinate_error() * edge.length;
    const auto inside = [&](Point2 p) {
      const double side = Cross(edge.b - edge.a, p - edge.a);
      return forward ? side > doubt : side < -doubt;
    };
    // Of the other corners the neighbours are nearest to the edge's line.
    const std::size_t first = forward ? a : b;
    if (corners > 2 && !(inside(hull[(first + 2) % corners]) && inside(hull[(first + corners - 1) % corners])))
      return false;
    for (const Probe& probe : scene.probes()) {
      if (probe.on_curve || probe.receivers.empty()) continue;
      if (inside(probe.low) && inside(probe.high) && inside({probe.low.x, probe.high.y}) &&
          inside({probe.high.x, probe.low.y})) {
        continue;
      }
      if (looks_left < probe.receivers.size()) return false;
      looks_left -= probe.receivers.size();
      for (const Receiver& receiver : probe.receivers) {
        if (receiver.element == ElementId::kNone && !inside(receiver.position)) return false;
      }
    }
  }
  return true;
}

bool LightNeverFades(const Scene& scene) {
  const std::vector<Curve>& curves = scene.curves();
  if (!std::all_of(curves.begin(), curves.end(), [](const Curve& c) { return c.reflectance.Max() == 1; })) return false;
  Connections connections;
  for (const Element& element : scene.elements()) {
    if (std::holds_alternative<Dielectric>(scene.curve(element.curve).material)) continue;
    if (!connections.Connect(element.a, element.b)) return true;
  }
  return false;
}

}  // namespace flatlight
