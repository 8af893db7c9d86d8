// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/row.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/math/check.h"
#include "core/plane/exact/edge.h"
#include "core/plane/reference/kernel.h"

namespace flatlight {

double OwnRadius(const Scene& scene, const Receiver& receiver, ElementId element) {
  if (receiver.element == ElementId::kNone) return 0;
  const Element& e = scene.element(element);
  if (e.kind != Element::Kind::kArc || scene.element(receiver.element).carrier != e.carrier) return 0;
  return e.radius;
}

EdgeErrors EndErrors::Add(const Receiver& receiver, ElementId element, const PieceEnd& end, double radiance) {
  const double known = scene_->coordinate_error(), followed = known + scene_->bezier_distance();
  const BezierPiece* const on = scene_->bezier_piece(scene_->element(element));
  const bool joint =
      on != nullptr && end.own && end.edge.kind == Edge::Kind::kVertex && (end.u == 0 ? on->from > 0 : on->to < 1);
  if (joint) joints_ = std::max(joints_, radiance * BoundErrors(end.edge, receiver.curvature, followed).s);
  return BoundErrors(end.edge, receiver.curvature, joint ? known : followed, receiver.curvature_change);
}

double SineBetween(const Chart& chart, const Receiver& receiver, double low, double high) {
  double sine[2];
  for (int i = 0; i < 2; ++i) {
    const Vector2 d = chart.At(i == 0 ? low : high).position - receiver.position;
    const double length = Length(d);
    sine[i] = length > 0 ? Dot(receiver.tangent, d) / length : 0;
  }
  return std::abs(sine[1] - sine[0]);
}

void RowBuilder::Build(const PanelMesh& mesh, const Receiver& receiver, bool high, const Row* before, Row& row) {
  row.panels.clear();
  row.low.clear();
  row.high.clear();
  row.coordinates = 0;
  before_ = before;
  next_before_ = 0;
  EndErrors errors(scene_);
  for (const VisiblePiece& piece : outlook_.From(receiver)) {
    AddPiece(mesh, receiver, piece, high, row);
    for (const PieceEnd& end : {piece.begin, piece.end})
      row.coordinates += errors.Add(receiver, piece.element, end, 1).s;
  }
  row.coordinates += errors.joints();
  // The receivers of the equation look along elements, not along the Béziers that they stand for.
  if (receiver.element != ElementId::kNone) {
    if (const BezierPiece* on = scene_.bezier_piece(scene_.element(receiver.element))) row.coordinates += 4 * on->tilt;
  }
  row.direct = before ? before->direct : outlook_.Direct(receiver);
}

bool RowBuilder::Copy(const Panel& panel, bool high, Row& row) {
  if (!before_ || panel.before == Panel::kNew) return false;
  std::size_t& p = next_before_;
  while (p < before_->panels.size() && before_->panels[p] != panel.before) ++p;
  FLATLIGHT_DCHECK(p < before_->panels.size());
  const auto copy = [p](const auto& from, std::size_t count, auto& to) {
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(p * count);
    to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  copy(before_->low, kLightCoefficients, row.low);
  if (high) copy(before_->high, kResidualCoefficients - kLightCoefficients, row.high);
  ++p;
  return true;
}

void RowBuilder::AddPiece(const PanelMesh& mesh, const Receiver& receiver, const VisiblePiece& piece, bool high,
                          Row& row) {
  const PanelMesh::Range range = mesh.On(piece.element, piece.side);
  if (range.first == range.last) return;
  const Chart& chart = charts_[static_cast<std::size_t>(piece.element)];
  const double radius = OwnRadius(scene_, receiver, piece.element);
  const double begin_u = std::min(piece.begin.u, piece.end.u), end_u = std::max(piece.begin.u, piece.end.u);
  const std::size_t count = high ? kResidualCoefficients : kLightCoefficients;
  double p[kResidualCoefficients];
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Panel& panel = mesh.panels()[i];
    const double from = std::max(begin_u, panel.low), to = std::min(end_u, panel.high);
    if (!(from < to)) continue;
    row.panels.push_back(static_cast<std::uint32_t>(i));
    if (Copy(panel, high, row)) continue;
    double moments[kResidualCoefficients] = {};
    const auto add_weight = [&](double u, double weight) {
      Legendre(panel.Local(u), count, p);
      for (std::size_t k = 0; k < count; ++k) moments[k] += weight * p[k];
    };
    const auto add = [&](double u, const Chart::Place& place, double weight) {
      add_weight(u, weight * Kernel(receiver, place, piece.side, radius).Value());
    };
    // What is left of a panel that runs into the receiver.
    const auto rest = [&](double u, double begin, double end) {
      add_weight(u, SineBetween(chart, receiver, begin, end));
    };
    ForEachPoint(chart, receiver.position, radius != 0, count_, from, to, 0, add, rest);
    row.low.insert(row.low.end(), moments, moments + kLightCoefficients);
    for (std::size_t k = kLightCoefficients; k < count; ++k) row.high.push_back(static_cast<float>(moments[k]));
  }
}

}  // namespace flatlight
