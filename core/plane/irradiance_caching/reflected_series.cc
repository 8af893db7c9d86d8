// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/reflected_series.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/plane/irradiance_caching/break_series.h"
#include "core/plane/reference/quadrature.h"
#include "core/plane/reference/row.h"

namespace flatlight {
namespace {

constexpr int kDigits = 12;
constexpr int kDeepest = 40;  // Halvings of a panel toward the receiver.

// Vectors that move with the receiver, in fixed coordinates.
struct VectorSeries {
  ArcSeries x, y;

  static VectorSeries Constant(Vector2 v) { return {ArcSeries::Constant(v.x), ArcSeries::Constant(v.y)}; }
  friend VectorSeries operator+(const VectorSeries& u, const VectorSeries& v) { return {u.x + v.x, u.y + v.y}; }
  friend VectorSeries operator-(const VectorSeries& u, const VectorSeries& v) { return {u.x - v.x, u.y - v.y}; }
  friend VectorSeries operator*(const ArcSeries& f, const VectorSeries& v) { return {f * v.x, f * v.y}; }
  friend VectorSeries operator*(double f, const VectorSeries& v) { return {f * v.x, f * v.y}; }
  Vector2 Now() const { return {x[0], y[0]}; }
};

ArcSeries Dot(const VectorSeries& u, const VectorSeries& v) { return u.x * v.x + u.y * v.y; }
ArcSeries Cross(const VectorSeries& u, const VectorSeries& v) { return u.x * v.y - u.y * v.x; }
VectorSeries Left(const VectorSeries& v) { return {-1.0 * v.y, v.x}; }

// The receiver on its way.
struct Moving {
  VectorSeries position, tangent, normal;  // The position relative to where it is now.

  explicit Moving(const Receiver& receiver) {
    tangent = VectorSeries::Constant(receiver.tangent);
    normal = VectorSeries::Constant(receiver.normal);
    const double kappa = receiver.curvature;
    for (std::size_t k = 0; k + 1 < kRecordOrders; ++k) {
      const double step = 1 / static_cast<double>(k + 1);
      tangent.x[k + 1] = step * kappa * normal.x[k], tangent.y[k + 1] = step * kappa * normal.y[k];
      normal.x[k + 1] = -step * kappa * tangent.x[k], normal.y[k + 1] = -step * kappa * tangent.y[k];
      position.x[k + 1] = step * tangent.x[k], position.y[k + 1] = step * tangent.y[k];
    }
  }
};

// An element's chart for moving numbers. Positions are relative to an origin.
class SeriesChart {
 public:
  SeriesChart(const Element& element, Point2 origin)
      : element_(element), a_(element.a - origin), arc_(element.kind == Element::Kind::kArc) {
    if (!arc_) return;
    half_tangent_ =
        flatlight::Cross(element.radial_a, element.radial_b) / (1 + flatlight::Dot(element.radial_a, element.radial_b));
  }

  struct Place {
    VectorSeries position, normal;  // The front's.
    ArcSeries speed;
  };
  Place At(const ArcSeries& u) const {
    if (!arc_) {
      const Vector2 along = element_.b - element_.a;
      return {VectorSeries::Constant(a_) + u * VectorSeries::Constant(along),
              VectorSeries::Constant(flatlight::Left(along) / element_.length), ArcSeries::Constant(element_.length)};
    }
    const ArcSeries one = ArcSeries::Constant(1);
    const ArcSeries t = half_tangent_ * u, scale = one / (one + t * t);
    const VectorSeries radial_a = VectorSeries::Constant(element_.radial_a), left = Left(radial_a);
    const VectorSeries radial = scale * ((one - t * t) * radial_a + 2.0 * t * left);
    const double r = element_.radius;
    return {VectorSeries::Constant(a_) + (2 * r) * (t * scale) * (left - t * radial_a),
            -element_.Orientation() * radial, (2 * r * std::abs(half_tangent_)) * scale};
  }

  // The number of a moving point of the element's circle.
  ArcSeries FindOnCircle(const VectorSeries& radial) const {
    const VectorSeries radial_a = VectorSeries::Constant(element_.radial_a);
    return Cross(radial_a, radial) / (half_tangent_ * (ArcSeries::Constant(1) + Dot(radial_a, radial)));
  }

  // The number at which an end of what is seen lies.
  ArcSeries End(const PieceEnd& end, const Receiver& receiver, const Moving& moving, bool own_circle) const {
    const ArcSeries fixed = ArcSeries::Constant(end.u);
    if (end.own && end.edge.kind == Edge::Kind::kVertex) return fixed;
    const DirectionSeries direction = SeriesOf(end.edge, receiver);
    const VectorSeries ray = direction.sine * moving.tangent + direction.cosine * moving.normal;
    if (!arc_) {
      const VectorSeries along = VectorSeries::Constant(element_.b - element_.a);
      const ArcSeries slope = Cross(along, ray);
      if (slope[0] == 0) return fixed;
      return Cross(moving.position - VectorSeries::Constant(a_), ray) / slope;
    }
    const double r = element_.radius;
    const VectorSeries center = VectorSeries::Constant(a_ - r * element_.radial_a);
    const VectorSeries from_center = moving.position - center;
    if (own_circle && end.edge.kind == Edge::Kind::kHorizon) return FindOnCircle((1 / r) * from_center);
    const auto nearer = [&](const VectorSeries& v, const VectorSeries& w) {
      const ArcSeries f = FindOnCircle(v), g = FindOnCircle(w);
      // What lies right across the circle has no number.
      const double off = std::abs(g[0] - end.u);
      return std::abs(f[0] - end.u) <= off || std::isnan(off) ? f : g;
    };
    const ArcSeries squared = Dot(from_center, from_center);
    if (end.own) {
      const ArcSeries tangent_squared = squared - ArcSeries::Constant(r * r);
      if (!(tangent_squared[0] > 0)) return fixed;
      const VectorSeries across = Sqrt(tangent_squared) * Left(from_center);
      const ArcSeries over = ArcSeries::Constant(1) / squared;
      return nearer(over * (r * from_center + across), over * (r * from_center - across));
    }
    const ArcSeries along = Dot(from_center, ray);
    const ArcSeries discriminant = along * along - squared + ArcSeries::Constant(r * r);
    if (!(discriminant[0] > 0)) return fixed;
    const ArcSeries root = Sqrt(discriminant);
    return nearer((1 / r) * (from_center + (-1.0 * along + root) * ray),
                  (1 / r) * (from_center + (-1.0 * along - root) * ray));
  }

 private:
  const Element& element_;
  Vector2 a_;
  bool arc_;
  double half_tangent_ = 0;
};

// The chord of a unit circle from where its normal is n to where it is m. Near n its direction is lost to rounding:
// then `ahead` tells whether m lies counter-clockwise (1) or clockwise (-1) of it.
ArcSeries Chord(const VectorSeries& n, const VectorSeries& m, double ahead) {
  constexpr double kNear = 1e-8;
  const ArcSeries sine = Cross(n, m), cosine = Dot(n, m);
  if (!(cosine[0] > 0)) {
    const VectorSeries d = m - n;
    return Sqrt(Dot(d, d));
  }
  const double side = std::abs(sine[0]) > kNear ? (sine[0] > 0 ? 1 : -1) : ahead;
  // 2 sin(a/2) = sin a / cos(a/2)
  return side * sine / Sqrt(0.5 * (ArcSeries::Constant(1) + cosine));
}

// Sums of Legendre polynomials of a moving place.
class Polynomial {
 public:
  explicit Polynomial(const ArcSeries& x) {
    p_[0] = ArcSeries::Constant(1);
    p_[1] = x;
    for (std::size_t k = 1; k + 1 < kLightCoefficients; ++k) {
      const auto n = static_cast<double>(k);
      p_[k + 1] = (1 / (n + 1)) * ((2 * n + 1) * x * p_[k] - n * p_[k - 1]);
    }
  }
  ArcSeries Sum(const double* coefficients) const {
    ArcSeries sum;
    for (std::size_t k = 0; k < kLightCoefficients; ++k) sum = sum + coefficients[k] * p_[k];
    return sum;
  }

 private:
  std::array<ArcSeries, kLightCoefficients> p_;
};

}  // namespace

ReflectedSeries::ReflectedSeries(const Scene& scene, const std::vector<Chart>& charts, const ReflectedLight& reflected)
    : scene_(scene),
      charts_(charts),
      reflected_(reflected),
      count_(kLightCoefficients + kRecordOrders, kDigits),
      kinks_(scene.elements().size(), *reflected.mesh, *reflected.light) {}

std::array<Spectrum, kRecordOrders> ReflectedSeries::At(const Receiver& receiver,
                                                        const std::vector<VisiblePiece>& pieces, bool occlusion) const {
  std::array<Spectrum, kRecordOrders> sum;
  const Moving moving(receiver);
  const std::size_t channels = reflected_.light->channels();
  for (const VisiblePiece& piece : pieces) {
    const PanelMesh::Range range = reflected_.mesh->On(piece.element, piece.side);
    if (range.first == range.last || !(piece.extent > 0)) continue;
    const Element& element = scene_.element(piece.element);
    const Chart& chart = charts_[static_cast<std::size_t>(piece.element)];
    const SeriesChart series_chart(element, receiver.position);
    const double own_radius = OwnRadius(scene_, receiver, piece.element);
    const bool forward = piece.begin.u <= piece.end.u;
    const PieceEnd& first = forward ? piece.begin : piece.end;
    const PieceEnd& last = forward ? piece.end : piece.begin;
    const auto end_of = [&](const PieceEnd& end) {
      return occlusion ? series_chart.End(end, receiver, moving, own_radius != 0) : ArcSeries::Constant(end.u);
    };
    const ArcSeries low = end_of(first), high = end_of(last);
    const double sign = piece.side == Side::kFront ? 1 : -1;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Panel& panel = reflected_.mesh->panels()[i];
      const ArcSeries from = first.u >= panel.low ? low : ArcSeries::Constant(panel.low);
      const ArcSeries to = last.u <= panel.high ? high : ArcSeries::Constant(panel.high);
      if (!(std::max(first.u, panel.low) < std::min(last.u, panel.high))) continue;
      const double stretch = 2 / (panel.high - panel.low);
      const auto add = [&](const ArcSeries& u, const ArcSeries& weight) {
        const SeriesChart::Place place = series_chart.At(u);
        const VectorSeries d = place.position - moving.position;
        const auto kernel_of = [&] {
          if (own_radius != 0) {
            const bool near_first = std::abs(u[0] - first.u) <= std::abs(u[0] - last.u);
            const double ahead = near_first == (element.Orientation() > 0) ? 1 : -1;
            return (0.25 / std::abs(own_radius)) * Chord(moving.normal, sign * place.normal, ahead);
          }
          const ArcSeries q = Dot(d, d);
          return (-sign * Dot(moving.normal, d)) * Dot(place.normal, d) / (q * Sqrt(q));
        };
        const ArcSeries kernel = kernel_of();
        const ArcSeries weighted = weight * place.speed * kernel;
        const Polynomial polynomial(stretch * (u - ArcSeries::Constant(panel.low)) - ArcSeries::Constant(1));
        for (std::size_t c = 0; c < channels; ++c) {
          const ArcSeries irradiance = weighted * polynomial.Sum(reflected_.light->Of(i, c));
          for (std::size_t m = 0; m < kRecordOrders; ++m) sum[m].value[c] += irradiance.Derivative(m);
        }
      };
      // Halves, and halves of them, where the receiver is near.
      const auto integrate = [&](const auto& self, const ArcSeries& begin, const ArcSeries& end, int depth) -> void {
        std::size_t points = count_.For(3);
        if (own_radius == 0) {
          const double roundness = chart.Roundness(receiver.position, begin[0], end[0]);
          if (!(roundness >= PointCount::kNearest)) {
            if (depth == kDeepest || !(begin[0] < end[0])) return;
            const ArcSeries middle = 0.5 * (begin + end);
            self(self, begin, middle, depth + 1);
            self(self, middle, end, depth + 1);
            return;
          }
          points = count_.For(roundness);
        }
        const GaussRule& rule = Gauss(points);
        const ArcSeries half = 0.5 * (end - begin);
        for (std::size_t k = 0; k < points; ++k) {
          add(0.5 * ((1 - rule.node[k]) * begin + (1 + rule.node[k]) * end), rule.weight[k] * half);
        }
      };
      integrate(integrate, from, to, 0);
    }
  }
  for (Spectrum& spectrum : sum)
    for (std::size_t c = channels; c < kMaxChannels; ++c) spectrum.value[c] = spectrum.value[0];
  return sum;
}

}  // namespace flatlight
