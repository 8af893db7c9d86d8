// SPDX-License-Identifier: Apache-2.0
#include "core/plane/ray_tracing/formulations.h"

#include <algorithm>
#include <cmath>

#include "core/plane/exact/edge.h"

namespace flatlight {
namespace {

// Grazing rays count as if they were this steep: what they add has no bound.
constexpr double kLeastCosine = 1e-3;

// A fixed point in a direction, for its motion alone.
Edge FixedEdge(double sine, double inverse_distance) {
  Edge edge;
  edge.s = sine, edge.c = CosineOf(sine), edge.q = inverse_distance;
  return edge;
}

// A sum of radiance times the motion of breaks.
class MotionSum {
 public:
  explicit MotionSum(const Receiver& receiver) : receiver_(receiver) {}

  void Add(const Spectrum& radiance, const Edge& at) {
    const EdgeDerivatives motion = Derive(at, receiver_.curvature, receiver_.curvature_change);
    sum_.first = sum_.first + motion.s_first * radiance;
    sum_.second = sum_.second + motion.s_second * radiance;
  }
  const GatherDerivatives& sum() const { return sum_; }

 private:
  const Receiver& receiver_;
  GatherDerivatives sum_;
};

}  // namespace

GatherDerivatives StratifiedDerivatives(const Receiver& receiver, const std::vector<GatheredRay>& gathered) {
  MotionSum sum(receiver);
  for (std::size_t k = 1; k < gathered.size(); ++k) {
    const GatheredRay &before = gathered[k - 1], &after = gathered[k];
    const Edge between = FixedEdge(after.begin, std::max(before.InverseDistance(), after.InverseDistance()));
    sum.Add(before.radiance - after.radiance, after.break_before.value_or(between));
  }
  return sum.sum();
}

GatherDerivatives PolylineDerivatives(const Receiver& receiver, const std::vector<GatheredRay>& gathered) {
  MotionSum sum(receiver);
  // By parts: each vertex moves the difference of the pieces beside it; the horizon does not move.
  Spectrum left = gathered.front().radiance;
  for (std::size_t k = 0; k < gathered.size(); ++k) {
    const GatheredRay& ray = gathered[k];
    const Edge vertex = FixedEdge(ray.sine, ray.InverseDistance());
    const GatheredRay* const next = k + 1 < gathered.size() ? &gathered[k + 1] : nullptr;
    Spectrum right = ray.radiance;
    if (next != nullptr && !next->break_before && next->InverseDistance() <= vertex.q) {
      right = next->radiance;
    }
    sum.Add(left - right, vertex);
    left = right;
    if (next == nullptr || !next->break_before) continue;
    // The nearer surface goes on to where it ends.
    sum.Add(ray.radiance - next->radiance, *next->break_before);
    left = next->radiance;
  }
  return sum.sum();
}

GatherDerivatives ArcLengthDerivatives(const Receiver& receiver, const std::vector<GatheredRay>& gathered) {
  GatherDerivatives sum;
  const double kappa = receiver.curvature;
  for (const GatheredRay& ray : gathered) {
    if (ray.element == ElementId::kNone) {
      // Light from infinitely far turns with the receiver alone: E' = -kappa sin, E'' = -kappa^2 cos, over cos.
      const double cosine = std::max(ray.cosine, kLeastCosine), stretch = ray.end - ray.begin;
      sum.first = sum.first + (-stretch * kappa * ray.sine / cosine) * ray.radiance;
      sum.second =
          sum.second + (-stretch * (kappa * kappa + receiver.curvature_change * ray.sine / cosine)) * ray.radiance;
      continue;
    }
    const double tau = Dot(receiver.tangent, ray.to), a = Dot(receiver.normal, ray.to);
    const double distance = Length(ray.to), q = 1 / (distance * distance);
    const double least = kLeastCosine * distance;
    const double b = std::max(-Dot(ray.normal, ray.to), least), steep = std::max(a, least);
    // Of the factors of the geometry term a b / distance^3, with the receiver's motion along its tangent.
    const double a1 = -kappa * tau, a2 = kappa - kappa * kappa * a - receiver.curvature_change * tau;
    const double b1 = Dot(ray.normal, receiver.tangent), b2 = kappa * Dot(ray.normal, receiver.normal);
    const double u1 = 3 * tau * q, u2 = 3 * (kappa * a - 1) * q + 15 * tau * tau * q * q;
    const double p1 = a1 / steep + b1 / b, p2 = a2 / steep + 2 * a1 * b1 / (steep * b) + b2 / b;
    const double stretch = ray.end - ray.begin;
    sum.first = sum.first + (stretch * (p1 + u1)) * ray.radiance;
    sum.second = sum.second + (stretch * (p2 + 2 * p1 * u1 + u2)) * ray.radiance;
  }
  return sum;
}

}  // namespace flatlight
