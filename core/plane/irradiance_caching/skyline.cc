// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/skyline.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <variant>

#include "core/plane/irradiance_caching/break_series.h"
#include "core/plane/irradiance_caching/light_series.h"
#include "core/plane/reference/row.h"

namespace flatlight {
namespace {

constexpr std::uint64_t kDark = 1;
// An edge has its circle's radius to rounding.
constexpr double kSameRadius = 1e-6;

std::uint64_t Mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t mixed = (a ^ (b + 0x9e3779b97f4a7c15u + (a << 6) + (a >> 2))) * 0xff51afd7ed558ccdu;
  return mixed ^ (mixed >> 32);
}

std::uint64_t Bits(double value) { return std::bit_cast<std::uint64_t>(value); }
std::uint64_t Bits(Point2 p) { return Mixed(Bits(p.x), Bits(p.y)); }

std::uint64_t IdentityOf(const Spectrum& radiance) {
  if (radiance.IsBlack()) return kDark;
  std::uint64_t identity = 2;
  for (const double value : radiance.value) identity = Mixed(identity, Bits(value));
  return identity;
}

}  // namespace

Skyline::Skyline(const RayCaster& caster, const std::vector<Chart>& charts, bool reflects,
                 const ReflectedSeries* reflected)
    : caster_(caster),
      scene_(caster.scene()),
      charts_(charts),
      reflects_(reflects),
      reflected_(reflected),
      outlook_(caster, charts) {}

void Skyline::Sign(std::uint64_t what) { signature_ = Mixed(signature_, what); }

std::uint64_t Skyline::IdentityOf(const VisiblePiece& piece, const Spectrum& radiance) const {
  const Element& element = scene_.element(piece.element);
  if (!reflects_ || scene_.curve(element.curve).reflectance.IsBlack()) return flatlight::IdentityOf(radiance);
  // Arcs of one circle are one.
  const bool arc = element.kind == Element::Kind::kArc;
  const std::uint64_t which =
      arc ? static_cast<std::uint64_t>(element.curve) : static_cast<std::uint64_t>(piece.element);
  return Mixed(Mixed(which, arc ? 3 : 4), piece.side == Side::kFront ? 5 : 6);
}

// What moves the break: a curve's end, an arc that is touched, or the place where two curves cross.
std::uint64_t Skyline::OwnerOf(const Edge& edge, const VisiblePiece* before, const VisiblePiece* after) const {
  const auto kind = static_cast<std::uint64_t>(edge.kind);
  if (edge.kind == Edge::Kind::kHorizon) return kind;
  std::uint64_t pair = 0;
  for (const VisiblePiece* piece : {before, after}) {
    if (!piece) continue;
    const Element& element = scene_.element(piece->element);
    if (edge.kind == Edge::Kind::kVertex && (edge.point == element.a || edge.point == element.b))
      return Mixed(kind, Bits(edge.point));
    if (edge.kind == Edge::Kind::kSilhouette) {
      // It slides along a Bézier from one of its pieces to the next.
      if (const BezierPiece* of = scene_.bezier_piece(element)) return Mixed(Mixed(kind, of->bezier), of->run);
    }
    if (edge.kind == Edge::Kind::kSilhouette && element.kind == Element::Kind::kArc &&
        std::abs(element.radius - std::abs(edge.signed_radius)) <= kSameRadius * element.radius)
      return Mixed(Mixed(kind, element.carrier), edge.signed_radius > 0 ? 7 : 8);
    pair = Mixed(pair, static_cast<std::uint64_t>(piece->element));
  }
  return Mixed(kind, pair);
}

void Skyline::AddBreak(const Edge& edge, const Spectrum& after, std::uint64_t owner, std::uint64_t identity) {
  if (identity != identity_) {
    Sign(owner);
    Sign(identity);
    identity_ = identity;
  }
  if (after == radiance_) return;
  breaks_.push_back({scene_.traits().has_beziers ? TrueEdge(scene_, receiver_, edge) : edge, radiance_, after});
  radiance_ = after;
}

void Skyline::SignKinks(const VisiblePiece& piece) {
  for (const PieceEnd* end : {&piece.begin, &piece.end}) {
    // The element's own end stays where it is.
    if (end->own && end->edge.kind == Edge::Kind::kVertex) continue;
    Sign(reflected_->kinks().Below(piece.element, piece.side, end->u));
  }
}

void Skyline::LookFrom(const Receiver& receiver) {
  receiver_ = receiver;
  pieces_ = &outlook_.From(receiver);
  breaks_.clear();
  radiance_ = {};
  identity_ = kDark;
  signature_ = 0;
  const Spectrum& sky = scene_.environment();
  const std::uint64_t sky_identity = flatlight::IdentityOf(sky);
  const VisiblePiece* before = nullptr;
  bool sky_before = false;
  for (const VisiblePiece& piece : *pieces_) {
    sky_before = sky_before || piece.after_sky;
    // What is not seen yet may come into view as the receiver moves on.
    if (!(piece.extent > 0)) continue;
    if (std::exchange(sky_before, false)) {
      AddBreak(before ? before->end.edge : HorizonEdge(-1), sky,
               before ? OwnerOf(before->end.edge, before, nullptr) : 2, sky_identity);
      before = nullptr;
    }
    const Spectrum radiance = scene_.curve_of(piece.element).EmittedRadiance(piece.side);
    AddBreak(piece.begin.edge, radiance, OwnerOf(piece.begin.edge, before, &piece), IdentityOf(piece, radiance));
    if (reflected_) SignKinks(piece);
    before = &piece;
  }
  const bool ends_in_sky = !before || before->end.edge.kind != Edge::Kind::kHorizon;
  if (ends_in_sky)
    AddBreak(before ? before->end.edge : HorizonEdge(-1), sky, before ? OwnerOf(before->end.edge, before, nullptr) : 2,
             sky_identity);
  AddBreak(HorizonEdge(1), {}, 2, kDark);
  lights_ = {};
  for (const Light& light : scene_.lights()) {
    const std::optional<ArcSeries> series = LightSeries(light, receiver, caster_);
    Sign(series ? 11 : 12);
    if (!series) continue;
    const auto* point = std::get_if<PointLight>(&light.kind);
    const Spectrum& strength = point ? point->intensity : std::get<DirectionalLight>(light.kind).irradiance;
    for (std::size_t k = 0; k < kRecordOrders; ++k) lights_[k] = lights_[k] + series->Derivative(k) * strength;
  }
}

std::array<Spectrum, kRecordOrders> Skyline::Irradiance() const {
  std::array<Spectrum, kRecordOrders> direct = lights_;
  const Edge* begin = nullptr;
  for (const Break& b : breaks_) {
    if (begin) direct[0] = direct[0] + SineDifference(*begin, b.edge, receiver_) * b.before;
    begin = &b.edge;
    const ArcSeries sine = SineSeries(b.edge, receiver_);
    const Spectrum jump = b.before - b.after;
    for (std::size_t k = 1; k < kRecordOrders; ++k) direct[k] = direct[k] + sine.Derivative(k) * jump;
  }
  if (reflected_) {
    const std::array<Spectrum, kRecordOrders> more = reflected_->At(receiver_, *pieces_);
    for (std::size_t k = 0; k < kRecordOrders; ++k) direct[k] = direct[k] + more[k];
  }
  for (double& value : direct[0].value) value = std::max(value, 0.0);
  return direct;
}

double Skyline::FixedSecond(const VisiblePiece& piece, const PieceEnd& end) const {
  const double kappa = receiver_.curvature;
  if (end.edge.kind == Edge::Kind::kHorizon && OwnRadius(scene_, receiver_, piece.element) != 0) {
    // The receiver's own circle runs on to the receiver itself.
    return -0.25 * end.edge.s * kappa * kappa;
  }
  Edge foot = end.edge;
  if (end.own) {
    foot.kind = Edge::Kind::kVertex, foot.signed_radius = 0;
  } else {
    foot = VertexEdge(receiver_, charts_[static_cast<std::size_t>(piece.element)].At(end.u).position);
  }
  return Derive(foot, kappa).s_second;
}

void Skyline::Survey(Surroundings& surroundings) const {
  surroundings.radiometric = lights_[2];
  surroundings.geometric = 0;
  surroundings.turning = 0;
  for (const VisiblePiece& piece : *pieces_) {
    if (!(piece.extent > 0)) continue;
    const double second = FixedSecond(piece, piece.end) - FixedSecond(piece, piece.begin);
    surroundings.geometric += 0.5 * std::abs(second);
    const Spectrum radiance = scene_.curve_of(piece.element).EmittedRadiance(piece.side);
    surroundings.radiometric = surroundings.radiometric + second * radiance;
  }
  if (reflected_) surroundings.radiometric = surroundings.radiometric + reflected_->At(receiver_, *pieces_, false)[2];
  for (const Break& b : breaks_) surroundings.turning += std::abs(2 * SineSeries(b.edge, receiver_)[2]);
}

}  // namespace flatlight
