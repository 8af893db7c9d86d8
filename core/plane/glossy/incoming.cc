// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/incoming.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "core/math/trig.h"
#include "core/plane/reference/quadrature.h"
#include "core/plane/reference/row.h"

namespace flatlight {
namespace {

// Light is a polynomial of both the place and the direction on its panel.
constexpr std::size_t kDegree = kLightCoefficients + kDirectionCoefficients;
constexpr int kMostHalvings = 48;
// Between the ends of pieces: less is rounding.
constexpr double kLeastGap = 1e-12;
// Places on a panel between which the direction to the receiver is taken to turn one way.
constexpr int kTurns = 4;
constexpr int kBisections = 52;
constexpr std::size_t kAnglePoints = 16;
constexpr double kWidest = 0.5;  // rad
// Roundness of what is seen of the receiver's own circle: directions turn evenly.
constexpr double kOnOneCircle = 3;
constexpr double kGrazing = 1e-6;

double AngleFromNormal(LocalDirection direction) {
  const double angle = AngleOf(std::max(direction.cosine, 0.0), std::abs(direction.sine));
  return direction.sine < 0 ? -angle : angle;
}

LocalDirection Of(const Edge& edge) { return {edge.s, edge.c}; }

double Cosine(LocalDirection a, LocalDirection b) { return a.sine * b.sine + a.cosine * b.cosine; }

}  // namespace

Incoming::Incoming(const RayCaster& caster, const std::vector<Chart>& charts, int digits)
    : caster_(caster), scene_(caster.scene()), charts_(charts), count_(kDegree, digits), outlook_(caster, charts) {}

void Incoming::From(const Receiver& receiver, const CellMesh& mesh, bool emission, double widest) {
  receiver_ = receiver;
  mesh_ = &mesh;
  widest_ = widest;
  cosine_of_widest_ = widest < std::numbers::pi ? SinCos(widest).cos : -2;
  rays_.clear();
  stretches_.clear();
  pieces_ = &outlook_.From(receiver);
  const bool sky = emission && scene_.traits().environment;
  double angle = -0.5 * std::numbers::pi;
  for (const VisiblePiece& piece : *pieces_) {
    if (sky) {
      if (piece.after_sky) AddSky(angle, AngleFromNormal(Of(piece.begin.edge)));
      angle = AngleFromNormal(Of(piece.end.edge));
    }
    const Curve& curve = scene_.curve_of(piece.element);
    const bool emits = emission && curve.Emits() && (piece.side == Side::kFront || curve.two_sided);
    emitted_ = emits ? &curve.radiance : nullptr;
    const double low = std::min(piece.begin.u, piece.end.u), high = std::max(piece.begin.u, piece.end.u);
    radius_ = OwnRadius(scene_, receiver_, piece.element);
    const PanelMesh::Range range = mesh.panels().On(piece.element, piece.side);
    if (range.first == range.last) {
      if (emitted_) AddStretch(piece, IncomingRay::kNoCell, low, high, 0);
      continue;
    }
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Panel& panel = mesh.panels().panels()[i];
      AddPanel(piece, i, std::max(low, panel.low), std::min(high, panel.high));
    }
  }
  if (sky) AddSky(angle, 0.5 * std::numbers::pi);
}

TurningRay Incoming::RayTo(const IncomingStretch& stretch, double u) const {
  const Chart::Place place = charts_[static_cast<std::size_t>(stretch.element)].At(u);
  const Vector2 d = place.position - receiver_.position;
  const double r = Length(d), sign = stretch.side == Side::kFront ? 1 : -1;
  TurningRay ray;
  // On one circle an angle at its border is half of that at its centre; where the circle runs into the receiver, its
  // distance tells the direction.
  if (stretch.radius != 0) {
    ray.slope = 0.5 * place.speed / stretch.radius;
    const double cosine = 0.5 * r / stretch.radius;
    if (cosine < kGrazing) {
      ray.in = {stretch.turn * std::sqrt((1 - cosine) * (1 + cosine)), cosine};
      ray.half_tangent = HalfTangent({Dot(place.tangent, receiver_.tangent) > 0 ? -ray.in.sine : ray.in.sine, cosine});
      return ray;
    }
  }
  if (!(r > 0)) return ray;
  ray.in = {Dot(receiver_.tangent, d) / r, std::max(Dot(receiver_.normal, d) / r, 0.0)};
  const LocalDirection out = {-Dot(place.tangent, d) / r, std::max(-sign * Dot(Left(place.tangent), d) / r, 0.0)};
  if (stretch.radius == 0) ray.slope = out.cosine * place.speed / r;
  ray.half_tangent = HalfTangent(out);
  return ray;
}

TurningRay Incoming::RayAt(const IncomingStretch& stretch, double number) const {
  if (stretch.element != ElementId::kNone) return RayTo(stretch, number);
  const SinCosValue turn = SinCos(number);
  return {{turn.sin, turn.cos}, 1, 0};
}

IncomingStretch Incoming::StretchOf(const VisiblePiece& piece, double low, double high) const {
  IncomingStretch stretch;
  stretch.first = rays_.size();
  stretch.element = piece.element;
  stretch.side = piece.side;
  stretch.low = low, stretch.high = high;
  stretch.radius = radius_;
  if (radius_ != 0) {
    // It turns by at most a quarter in all.
    const Point2 middle = charts_[static_cast<std::size_t>(piece.element)].At(0.5 * (low + high)).position;
    stretch.turn = Dot(receiver_.tangent, middle - receiver_.position) < 0 ? -1 : 1;
  }
  return stretch;
}

// Cut where the direction of its light toward the receiver goes over from one cell to another.
void Incoming::AddPanel(const VisiblePiece& piece, std::size_t panel, double from, double to) {
  if (!(from < to)) return;
  const PanelMesh::Range range = mesh_->CellsOf(panel);
  if (range.last == range.first + 1) return AddStretch(piece, static_cast<std::uint32_t>(range.first), from, to, 0);
  const IncomingStretch whole = StretchOf(piece, from, to);
  const auto direction_at = [&](double u) { return RayTo(whole, u).half_tangent; };
  std::vector<double> cuts = {from};
  for (int k = 0; k < kTurns; ++k) {
    const double low = from + (to - from) * k / kTurns;
    const double high = k + 1 < kTurns ? from + (to - from) * (k + 1) / kTurns : to;
    const double at_low = direction_at(low), at_high = direction_at(high);
    const std::size_t first = cuts.size();
    for (std::size_t i = range.first + 1; i < range.last; ++i) {
      const double border = mesh_->cells()[i].low;
      if ((at_low < border) == (at_high < border)) continue;
      double a = low, b = high;
      for (int step = 0; step < kBisections; ++step) {
        const double middle = 0.5 * (a + b);
        ((direction_at(middle) < border) == (at_low < border) ? a : b) = middle;
      }
      cuts.push_back(0.5 * (a + b));
    }
    std::sort(cuts.begin() + static_cast<std::ptrdiff_t>(first), cuts.end());
  }
  cuts.push_back(to);
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    const double t = direction_at(0.5 * (cuts[k] + cuts[k + 1]));
    AddStretch(piece, static_cast<std::uint32_t>(mesh_->CellAt(panel, t)), cuts[k], cuts[k + 1], 0);
  }
}

void Incoming::AddStretch(const VisiblePiece& piece, std::uint32_t cell, double from, double to, int depth) {
  if (!(from < to)) return;
  const Chart& chart = charts_[static_cast<std::size_t>(piece.element)];
  const double roundness = radius_ != 0 ? kOnOneCircle : chart.Roundness(receiver_.position, from, to);
  IncomingStretch stretch = StretchOf(piece, from, to);
  const bool near = !(roundness >= PointCount::kNearest);
  if (!near) {
    stretch.at_low = RayTo(stretch, from).in;
    stretch.at_high = RayTo(stretch, to).in;
  }
  if (near || Cosine(stretch.at_low, stretch.at_high) < cosine_of_widest_) {
    const double middle = 0.5 * (from + to);
    if (depth == kMostHalvings || !(from < middle && middle < to)) return AddEnd(piece, cell, from, to);
    AddStretch(piece, cell, from, middle, depth + 1);
    return AddStretch(piece, cell, middle, to, depth + 1);
  }
  const GaussRule& rule = Gauss(count_.For(roundness));
  stretch.count = rule.node.size();
  for (std::size_t k = 0; k < stretch.count; ++k) {
    const double u = 0.5 * ((1 - rule.node[k]) * from + (1 + rule.node[k]) * to);
    const TurningRay ray = RayTo(stretch, u);
    IncomingRay incoming;
    incoming.weight = 0.5 * (to - from) * rule.weight[k] * ray.slope;
    incoming.in = ray.in;
    incoming.emitted = emitted_;
    if (cell != IncomingRay::kNoCell) SetPlace(cell, u, ray.half_tangent, incoming);
    rays_.push_back(incoming);
  }
  stretches_.push_back(stretch);
}

void Incoming::SetPlace(std::uint32_t cell, double u, double half_tangent, IncomingRay& ray) const {
  const DirectionCell& of = mesh_->cells()[cell];
  ray.cell = cell;
  ray.x = std::clamp(mesh_->panels().panels()[of.panel].Local(u), -1.0, 1.0);
  if (of.directions > 1) ray.y = std::clamp(of.Local(half_tangent), -1.0, 1.0);
}

template <typename Add>
void Incoming::AddAngles(double from, double to, const Add& add) {
  if (!(to - from > kLeastGap)) return;
  const auto parts = static_cast<int>(std::ceil((to - from) / std::min(widest_, kWidest)));
  const GaussRule& rule = Gauss(kAnglePoints);
  for (int part = 0; part < parts; ++part) {
    IncomingStretch stretch;
    stretch.first = rays_.size();
    stretch.count = kAnglePoints;
    stretch.low = from + (to - from) * part / parts;
    stretch.high = from + (to - from) * (part + 1) / parts;
    stretch.at_low = RayAt(stretch, stretch.low).in;
    stretch.at_high = RayAt(stretch, stretch.high).in;
    for (std::size_t k = 0; k < kAnglePoints; ++k) {
      IncomingRay incoming;
      const double angle = 0.5 * ((1 - rule.node[k]) * stretch.low + (1 + rule.node[k]) * stretch.high);
      incoming.in = RayAt(stretch, angle).in;
      incoming.weight = 0.5 * (stretch.high - stretch.low) * rule.weight[k];
      add(incoming);
    }
    stretches_.push_back(stretch);
  }
}

void Incoming::AddEnd(const VisiblePiece& piece, std::uint32_t cell, double from, double to) {
  const auto angle_at = [&](double u) {
    if (u == piece.begin.u) return AngleFromNormal(Of(piece.begin.edge));
    if (u == piece.end.u) return AngleFromNormal(Of(piece.end.edge));
    return AngleFromNormal(RayTo(StretchOf(piece, from, to), u).in);
  };
  const double at_from = angle_at(from), at_to = angle_at(to), u = 0.5 * (from + to);
  const Chart::Place place = charts_[static_cast<std::size_t>(piece.element)].At(u);
  const Vector2 normal = (piece.side == Side::kFront ? 1.0 : -1.0) * Left(place.tangent);
  AddAngles(std::min(at_from, at_to), std::max(at_from, at_to), [&](IncomingRay& ray) {
    ray.emitted = emitted_;
    if (cell != IncomingRay::kNoCell) {
      const Vector2 d = ray.in.sine * receiver_.tangent + ray.in.cosine * receiver_.normal;
      const double t = HalfTangent({-Dot(place.tangent, d), std::max(-Dot(normal, d), 0.0)});
      SetPlace(static_cast<std::uint32_t>(mesh_->CellAt(mesh_->cells()[cell].panel, t)), u, t, ray);
    }
    rays_.push_back(ray);
  });
}

void Incoming::AddSky(double from, double to) {
  AddAngles(from, to, [&](IncomingRay& ray) {
    ray.emitted = &scene_.environment();
    rays_.push_back(ray);
  });
}

std::vector<Incoming::Beam> Incoming::Beams() const {
  std::vector<Beam> beams;
  const auto in = [&](Vector2 toward) {
    return LocalDirection{Dot(receiver_.tangent, toward), Dot(receiver_.normal, toward)};
  };
  for (const Light& light : scene_.lights()) {
    if (const auto* point = std::get_if<PointLight>(&light.kind)) {
      const Vector2 toward = point->position - receiver_.position;
      const double distance = Length(toward);
      const LocalDirection direction = in(toward / distance);
      if (!(direction.cosine > 0)) continue;
      if (!caster_.Visible({receiver_.position, receiver_.element}, {point->position, ElementId::kNone})) continue;
      beams.push_back({direction, (point->Share(-toward) * direction.cosine / distance) * point->intensity});
      continue;
    }
    const auto& directional = std::get<DirectionalLight>(light.kind);
    const LocalDirection direction = in(-directional.direction);
    if (!(direction.cosine > 0)) continue;
    if (caster_.ClosestHit({receiver_.position, receiver_.element}, -directional.direction).has_value()) continue;
    beams.push_back({direction, direction.cosine * directional.irradiance});
  }
  return beams;
}

}  // namespace flatlight
