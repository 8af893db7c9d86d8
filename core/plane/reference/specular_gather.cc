// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/specular_gather.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/math/trig.h"
#include "core/plane/reference/quadrature.h"

namespace flatlight {
namespace {

constexpr std::size_t kPoints = 10;
constexpr int kMostHalvings = 40;

}  // namespace

Spectrum EmittedBy(const Scene& scene, const SpecularPiece& piece) {
  if (piece.element == ElementId::kNone) return scene.environment();
  return scene.curve_of(piece.element).EmittedRadiance(piece.side);
}

std::optional<double> SpecularGather::PlaceOf(const Receiver& receiver, const SpecularPiece& piece,
                                              const SpecularRay& ray) const {
  const std::optional<double> distance = DistanceBehind(scene_, receiver, *piece.way, ray, piece.element, piece.far);
  if (!distance) return std::nullopt;
  return charts_[static_cast<std::size_t>(piece.element)].Find(ray.from + *distance * ray.direction);
}

std::size_t SpecularGather::PanelAt(const Receiver& receiver, const SpecularPiece& piece, const PanelMesh& mesh,
                                    double x) const {
  const PanelMesh::Range range = mesh.On(piece.element, piece.side);
  const std::optional<SpecularRay> ray = FollowWay(scene_, *piece.way, piece.directions->At(x));
  const std::optional<double> u = ray ? PlaceOf(receiver, piece, *ray) : std::nullopt;
  if (!u) return range.last;
  std::size_t i = range.first;
  while (i + 1 < range.last && mesh.panels()[i].high <= *u) ++i;
  return i;
}

SpecularGather::Moments SpecularGather::OfPiece(const Receiver& receiver, const SpecularPiece& piece) const {
  return Of(receiver, piece, nullptr, 1, piece.begin, piece.end);
}

SpecularGather::Moments SpecularGather::Of(const Receiver& receiver, const SpecularPiece& piece, const Panel* panel,
                                           std::size_t count, double from, double to) const {
  Moments all;
  const double theta_from = piece.directions->At(from), theta_to = piece.directions->At(to);
  if (panel == nullptr && piece.way->straight) {
    all.value[0] = SinCos(theta_to).sin - SinCos(theta_from).sin;
    return all;
  }
  // Where rays begin to touch what they end on is smooth neither in theta nor in the piece's own numbers.
  const Directions part{from, to, panel != nullptr && scene_.element(piece.element).kind == Element::Kind::kArc,
                        nullptr};
  const GaussRule& rule = Gauss(kPoints);
  const auto sum_over = [&](double low, double high) {
    Values sum{};
    double p[kResidualCoefficients] = {1};
    for (std::size_t k = 0; k < kPoints; ++k) {
      const double x = 0.5 * ((1 - rule.node[k]) * low + (1 + rule.node[k]) * high);
      const double number = part.At(x), theta = piece.directions->At(number);
      const std::optional<SpecularRay> ray = FollowWay(scene_, *piece.way, theta);
      if (!ray) continue;
      if (panel != nullptr) {
        const std::optional<double> u = PlaceOf(receiver, piece, *ray);
        if (!u) continue;
        Legendre(std::clamp(panel->Local(*u), -1.0, 1.0), count, p);
      }
      const double weight = 0.5 * (high - low) * rule.weight[k] * part.Slope(x) * piece.directions->Slope(number) *
                            SinCos(theta).cos * ray->share;
      for (std::size_t i = 0; i < count; ++i) sum[i] += weight * p[i];
    }
    return sum;
  };
  const double tolerance = tolerance_ * (theta_to - theta_from) / std::numbers::pi;
  // Depth first, so that the order of sums is fixed.
  const auto refine = [&](const auto& self, double low, double high, const Values& whole, int depth) -> void {
    const double middle = 0.5 * (low + high);
    const Values first = sum_over(low, middle), second = sum_over(middle, high);
    double off = 0;
    for (std::size_t i = 0; i < count; ++i) off = std::max(off, std::abs(first[i] + second[i] - whole[i]));
    if (off <= std::max(tolerance, 4e-16 * std::abs(whole[0])) || depth == kMostHalvings) {
      for (std::size_t i = 0; i < count; ++i) all.value[i] += first[i] + second[i];
      all.error += off;
      return;
    }
    self(self, low, middle, first, depth + 1);
    self(self, middle, high, second, depth + 1);
  };
  refine(refine, 0, 1, sum_over(0, 1), 0);
  return all;
}

}  // namespace flatlight
