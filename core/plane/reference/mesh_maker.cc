// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/mesh_maker.h"

#include <algorithm>
#include <utility>

#include "core/plane/box.h"
#include "core/plane/intersect.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Meetings nearer to each other, in the chart, count as one.
constexpr double kSame = 1e-9;

bool Apart(const Element& e, const Element& f, double near) {
  // Every point of an element lies within its length of a.
  const double reach = e.length + f.length + near;
  return LengthSquared(e.a - f.a) > reach * reach;
}

// Whether a Bézier goes over from one element into the other: no corner, nothing meets there.
bool GoesOn(const Scene& scene, const Element& e, const Element& f) {
  const BezierPiece *const before = scene.bezier_piece(e), *const after = scene.bezier_piece(f);
  if (before == nullptr || after == nullptr || before->bezier != after->bezier || e.b != f.a) return false;
  if (e.kind != Element::Kind::kArc || f.kind != Element::Kind::kArc) return false;
  return e.Orientation() * f.Orientation() * Dot(e.radial_b, f.radial_a) > 0;
}

}  // namespace

std::vector<std::vector<double>> Meetings(const Scene& scene, const std::vector<Chart>& charts) {
  const std::vector<Element>& elements = scene.elements();
  const double near = 2 * scene.touch_distance();
  std::vector<std::vector<double>> meetings(elements.size());
  const auto add = [&](std::size_t i, Point2 p) { meetings[i].push_back(std::clamp(charts[i].Find(p), 0.0, 1.0)); };
  for (std::size_t i = 0; i < elements.size(); ++i) {
    for (std::size_t j = i + 1; j < elements.size(); ++j) {
      const Element &e = elements[i], &f = elements[j];
      if (e.carrier == f.carrier || Apart(e, f, near) || GoesOn(scene, e, f)) continue;
      for (const Point2 p : {e.a, e.b})
        if (DistanceTo(f, p) <= near) add(i, p), add(j, p);
      for (const Point2 p : {f.a, f.b})
        if (DistanceTo(e, p) <= near) add(i, p), add(j, p);
      const ElementCrossings crossings = CrossElements(e, f, scene.touch_distance());
      for (int c = 0; c < crossings.count; ++c) add(i, crossings.point[c]), add(j, crossings.point[c]);
    }
  }
  for (std::vector<double>& places : meetings) {
    for (double& u : places) u = u < kSame ? 0 : u > 1 - kSame ? 1 : u;
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end(), [](double l, double r) { return r - l < kSame; }),
                 places.end());
  }
  return meetings;
}

PanelMesh MeshBetween(const Scene& scene, const std::vector<std::vector<double>>& meetings) {
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    const auto id = static_cast<ElementId>(i);
    const Curve& curve = scene.curve_of(id);
    if (curve.reflectance.IsBlack() || IsSpecular(curve.material)) continue;
    std::vector<double> cuts(1, 0.0);
    bool meets = false;
    for (const double place : meetings[i]) {
      if (place > 0 && meets) cuts.push_back(0.5 * (cuts.back() + place));
      if (place > 0 && place < 1) cuts.push_back(place);
      meets = true;
    }
    cuts.push_back(1);
    for (const Side side : {Side::kFront, Side::kBack})
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k) panels.push_back({id, side, cuts[k], cuts[k + 1]});
  }
  return PanelMesh(meetings.size(), std::move(panels));
}

PanelMesh SplitMeshAt(const Scene& scene, const PanelMesh& mesh, std::vector<std::vector<double>> places) {
  for (std::vector<double>& on_element : places) std::sort(on_element.begin(), on_element.end());
  std::vector<std::vector<double>> by_panel(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Panel& panel = mesh.panels()[i];
    double last = panel.low;
    for (const double u : places[static_cast<std::size_t>(panel.element)]) {
      if (!(u > last + kSame && u < panel.high - kSame)) continue;
      by_panel[i].push_back(last = u);
    }
  }
  return SplitMesh(scene, mesh, by_panel);
}

PanelMesh SplitMesh(const Scene& scene, const PanelMesh& mesh, const std::vector<std::vector<double>>& places) {
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    Panel rest = mesh.panels()[i];
    rest.before = places[i].empty() ? static_cast<std::uint32_t>(i) : Panel::kNew;
    for (const double u : places[i]) {
      Panel part = rest;
      part.high = rest.low = u;
      panels.push_back(part);
    }
    panels.push_back(rest);
  }
  return PanelMesh(scene.elements().size(), std::move(panels));
}

}  // namespace flatlight
