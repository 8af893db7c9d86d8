// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/row.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/math/check.h"
#include "core/plane/exact/edge.h"
#include "core/plane/reference/kernel.h"
#include "core/plane/reference/moment_sum.h"
#include "core/plane/reference/quadrature.h"

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

bool EndErrors::IsDoubtful(const Receiver& receiver, const VisiblePiece& piece) const {
  const double known = scene_->coordinate_error();
  return piece.extent <= BoundErrors(piece.begin.edge, receiver.curvature, known).s +
                             BoundErrors(piece.end.edge, receiver.curvature, known).s;
}

double SineTo(const Chart& chart, const Receiver& receiver, double u) {
  const Vector2 d = chart.At(u).position - receiver.position;
  const double length = Length(d);
  return length > 0 ? Dot(receiver.tangent, d) / length : 0;
}

void RowBuilder::Build(const PanelMesh& mesh, const Receiver& receiver, bool high, Row* before, Row& row) {
  row.panels.clear();
  row.low.clear();
  row.high.clear();
  row.stretches.clear();
  row.specular.clear();
  row.tints.clear();
  row.pieces.clear();
  row.lost = 0;
  before_ = before;
  next_before_ = 0;
  if (before) {
    row.stretches = std::move(before->stretches);
    row.coordinates = before->coordinates;
    row.direct = before->direct;
    row.brightest = before->brightest;
    row.specular = std::move(before->specular);
    row.lost = before->lost;
  } else {
    row.coordinates = 0;
    row.brightest = scene_.environment();
    EndErrors errors(scene_);
    for (const VisiblePiece& piece : outlook_.From(receiver)) {
      if (errors.IsDoubtful(receiver, piece)) continue;
      const Spectrum emitted = scene_.curve_of(piece.element).EmittedRadiance(piece.side);
      for (int c = 0; c < kMaxChannels; ++c) row.brightest[c] = std::max(row.brightest[c], emitted[c]);
      const PanelMesh::Range range = mesh.On(piece.element, piece.side);
      const double low = std::min(piece.begin.u, piece.end.u), up = std::max(piece.begin.u, piece.end.u);
      if (range.first < range.last && low < up) row.stretches.push_back({piece.element, piece.side, low, up});
      for (const PieceEnd& end : {piece.begin, piece.end})
        row.coordinates += errors.Add(receiver, piece.element, end, 1).s;
    }
    row.coordinates += errors.joints();
    // The receivers of the equation look along elements, not along the Béziers that they stand for.
    if (receiver.element != ElementId::kNone) {
      if (const BezierPiece* on = scene_.bezier_piece(scene_.element(receiver.element)))
        row.coordinates += 4 * on->tilt;
    }
    row.direct = outlook_.Direct(receiver);
    if (specular_) AddEmission(receiver, row);
  }
  const std::size_t expected = before ? before->panels.size() + before->panels.size() / 4 : 2 * row.stretches.size();
  row.panels.reserve(expected);
  row.low.reserve(expected * kLightCoefficients);
  if (high) row.high.reserve(expected * (kResidualCoefficients - kLightCoefficients));
  for (const Row::Stretch& stretch : row.stretches) AddStretch(mesh, receiver, stretch, high, row);
  if (specular_) AddSpecular(mesh, receiver, high, row);
  if (before) *before = {};
}

void RowBuilder::AddEmission(const Receiver& receiver, Row& row) {
  SpecularView& view = specular_->view();
  row.specular = view.From(receiver);
  row.lost = view.lost();
  for (const SpecularPiece& piece : row.specular) {
    const Spectrum emitted = EmittedBy(scene_, piece);
    if (emitted.IsBlack()) continue;
    const SpecularGather::Moments moments = specular_->OfPiece(receiver, piece);
    row.direct = row.direct + moments.value[0] * (piece.way->tint * emitted);
    row.lost += moments.error;
    for (int c = 0; c < kMaxChannels; ++c) row.brightest[c] = std::max(row.brightest[c], emitted[c]);
  }
}

void RowBuilder::AddSpecular(const PanelMesh& mesh, const Receiver& receiver, bool high, Row& row) {
  const std::size_t count = high ? kResidualCoefficients : kLightCoefficients;
  row.tints.assign(row.panels.size(), Spectrum::Grey(1));
  row.pieces.assign(row.panels.size(), 0);
  std::uint32_t number = 0;
  for (const SpecularPiece& piece : row.specular) {
    ++number;
    specular_->OfPanels(receiver, piece, mesh, count, [&](std::size_t i, const auto& moments_of) {
      row.panels.push_back(static_cast<std::uint32_t>(i));
      row.tints.push_back(piece.way->tint);
      row.pieces.push_back(number);
      if (Copy(mesh.panels()[i], number, high, row)) return;
      const SpecularGather::Moments moments = moments_of();
      AddEntry(moments.value.data(), count, row);
      row.lost += moments.error;
    });
  }
}

void RowBuilder::AddEntry(const double* moments, std::size_t count, Row& row) const {
  row.low.insert(row.low.end(), moments, moments + kLightCoefficients);
  for (std::size_t k = kLightCoefficients; k < count; ++k) row.high.push_back(static_cast<float>(moments[k]));
}

bool RowBuilder::Copy(const Panel& panel, std::uint32_t piece, bool high, Row& row) {
  if (!before_ || panel.before == Panel::kNew) return false;
  std::size_t p = next_before_;
  const auto is_before = [&](std::size_t i) {
    return before_->panels[i] == panel.before && (before_->pieces.empty() || before_->pieces[i] == piece);
  };
  while (p < before_->panels.size() && !is_before(p)) ++p;
  FLATLIGHT_DCHECK(p < before_->panels.size() || piece > 0);
  if (p == before_->panels.size()) return false;  // Rounding cut a specular piece in another way.
  next_before_ = p + 1;
  const auto copy = [p](const auto& from, std::size_t count, auto& to) {
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(p * count);
    to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  copy(before_->low, kLightCoefficients, row.low);
  if (high) copy(before_->high, kResidualCoefficients - kLightCoefficients, row.high);
  return true;
}

// A panel that is seen as a whole, from afar: light from it is as good as a polynomial of as many coefficients as there
// are Gauss points, and higher polynomials on the panel give nothing.
void RowBuilder::AddWhole(const Chart& chart, const Panel& panel, const Receiver& receiver, double roundness, bool high,
                          double* moments) const {
  const std::size_t points = count_.For(roundness);
  const GaussRule& rule = Gauss(points);
  const double* p = LegendreAtGauss(points);
  const double half = 0.5 * (panel.high - panel.low);
  // Loops of constant length, for they take most of the time.
  double sum[kTabulated] = {};
  static_assert(kTabulated >= kResidualCoefficients);
  for (std::size_t i = 0; i < points; ++i, p += kTabulated) {
    const Chart::Place place = chart.At(panel.At(rule.node[i]));
    const double weight = half * rule.weight[i] * place.speed * Kernel(receiver, place, panel.side, 0).Value();
    if (high) {
      for (std::size_t k = 0; k < kTabulated; ++k) sum[k] += weight * p[k];
    } else {
      for (std::size_t k = 0; k < kLightCoefficients; ++k) sum[k] += weight * p[k];
    }
  }
  std::copy_n(sum, high ? kResidualCoefficients : kLightCoefficients, moments);
}

void RowBuilder::AddStretch(const PanelMesh& mesh, const Receiver& receiver, const Row::Stretch& stretch, bool high,
                            Row& row) {
  const PanelMesh::Range range = mesh.On(stretch.element, stretch.side);
  const Chart& chart = charts_[static_cast<std::size_t>(stretch.element)];
  const double radius = OwnRadius(scene_, receiver, stretch.element);
  // The first panel that reaches beyond its low end.
  const auto first = std::partition_point(mesh.panels().begin() + static_cast<std::ptrdiff_t>(range.first),
                                          mesh.panels().begin() + static_cast<std::ptrdiff_t>(range.last),
                                          [&](const Panel& panel) { return panel.high <= stretch.low; });
  const std::size_t count = high ? kResidualCoefficients : kLightCoefficients;
  for (auto i = static_cast<std::size_t>(first - mesh.panels().begin()); i < range.last; ++i) {
    const Panel& panel = mesh.panels()[i];
    const double from = std::max(stretch.low, panel.low), to = std::min(stretch.high, panel.high);
    if (!(from < to)) break;
    row.panels.push_back(static_cast<std::uint32_t>(i));
    if (Copy(panel, 0, high, row)) continue;
    double moments[kResidualCoefficients] = {};
    const bool whole = from == panel.low && to == panel.high && radius == 0;
    const double roundness = whole ? chart.Roundness(receiver.position, from, to) : 0;
    if (whole && roundness >= PointCount::kNearest) {
      AddWhole(chart, panel, receiver, roundness, high, moments);
    } else {
      MomentSum sum(high);
      const auto add_weight = [&](double u, double weight) { sum.Add(panel.Local(u), weight); };
      const auto add = [&](double u, const Chart::Place& place, double weight) {
        add_weight(u, weight * Kernel(receiver, place, stretch.side, radius).Value());
      };
      // What is left of a panel that runs into the receiver.
      const auto rest = [&](double u, double begin, double end) {
        add_weight(u, std::abs(SineTo(chart, receiver, end) - SineTo(chart, receiver, begin)));
      };
      ForEachPoint(chart, receiver.position, radius != 0, high ? high_count_ : count_, from, to, 0, add, rest);
      std::copy_n(sum.Finish(), count, moments);
    }
    AddEntry(moments, count, row);
  }
}

}  // namespace flatlight
