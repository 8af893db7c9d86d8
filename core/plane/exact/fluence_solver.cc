// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/fluence_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "core/math/power.h"

namespace flatlight {
namespace {

// The receivers at a point look along no direction that scenes are built in: their horizons meet few vertices.
constexpr Vector2 kLook{0.5403023058681398, 0.8414709848078965};  // cos 1, sin 1.

// From so many sides of a box on the first two terms of 1/r's mean are enough: the next is below 1e-11 of it, as much
// as cancels in the closed form there.
constexpr double kFar = 256;

double AreaHyperbolicSine(double x) { return Log(x + std::sqrt(1 + x * x)); }

// The integral of 1/r over the box from the origin to (x, y), which has the sign of x y.
double InverseDistance(double x, double y) {
  const double a = std::abs(x), b = std::abs(y);
  if (a == 0 || b == 0) return 0;
  const double sum = a * AreaHyperbolicSine(b / a) + b * AreaHyperbolicSine(a / b);
  return (x < 0) == (y < 0) ? sum : -sum;
}

// The mean of 1/r over a box with its centre at `at` from the light.
double MeanInverseDistance(Vector2 at, Vector2 box) {
  const double squared = LengthSquared(at);
  const double side = std::max(box.x, box.y);
  if (squared > kFar * kFar * side * side) {
    const double q = 1 / squared, root = std::sqrt(q);
    const double xx = box.x * box.x, yy = box.y * box.y;
    const double second = xx * (2 * at.x * at.x - at.y * at.y) + yy * (2 * at.y * at.y - at.x * at.x);
    return root * (1 + second * q * q / 24);
  }
  const double left = at.x - 0.5 * box.x, right = at.x + 0.5 * box.x;
  const double low = at.y - 0.5 * box.y, high = at.y + 0.5 * box.y;
  const double integral = InverseDistance(right, high) - InverseDistance(left, high) - InverseDistance(right, low) +
                          InverseDistance(left, low);
  return integral / (box.x * box.y);
}

const Spectrum& StrengthOf(const Light& light) {
  const auto* point = std::get_if<PointLight>(&light.kind);
  return point ? point->intensity : std::get<DirectionalLight>(light.kind).irradiance;
}

// What the strength of a light that is seen gives a box.
double Falloff(const Light& light, Point2 center, Vector2 box) {
  const auto* point = std::get_if<PointLight>(&light.kind);
  return point ? MeanInverseDistance(center - point->position, box) : 1;
}

}  // namespace

FluenceSolver::FluenceSolver(const RayCaster& caster, ExactOptions options, const Triangulation* triangulation)
    : caster_(caster), options_(options), solver_(caster.scene(), caster.bvh(), options, triangulation) {}

Spectrum FluenceSolver::OfCurves(Point2 point) {
  Receiver receiver;
  receiver.position = point;
  receiver.half_angle = 0.5 * std::numbers::pi;
  Spectrum sum;
  for (const Vector2 normal : {kLook, -kLook}) {
    receiver.normal = normal;
    receiver.tangent = Right(normal);
    sum = sum + solver_.Evaluate(receiver).irradiance;
  }
  return sum;
}

double FluenceSolver::Seen(const Light& light, Point2 point) const {
  const SurfacePoint at{point, ElementId::kNone};
  if (const auto* directional = std::get_if<DirectionalLight>(&light.kind)) {
    return caster_.ClosestHit(at, -directional->direction) ? 0 : 1;
  }
  const auto& lamp = std::get<PointLight>(light.kind);
  // In the light's own place every direction is as good as another.
  if (point == lamp.position) return 1;
  const double share = lamp.Share(point - lamp.position);
  return share > 0 && caster_.Visible(at, {lamp.position, ElementId::kNone}) ? share : 0;
}

Spectrum FluenceSolver::At(Point2 point, Vector2 box) {
  Spectrum sum = OfCurves(point);
  for (const Light& light : caster_.scene().lights()) {
    const double seen = Seen(light, point);
    if (seen > 0) sum = sum + seen * Falloff(light, point, box) * StrengthOf(light);
  }
  return sum;
}

BoxMean FluenceSolver::Mean(Point2 center, Vector2 box, const Spectrum& tolerance) {
  BoxQuadrature curves([this](Point2 point) { return OfCurves(point); }, [](Point2, Vector2) { return 1.0; },
                       options_.channels);
  BoxMean mean = curves.Mean(center, box, tolerance);
  for (const Light& light : caster_.scene().lights()) {
    const Spectrum& strength = StrengthOf(light);
    if (strength.IsBlack()) continue;
    Spectrum least;
    least[0] = std::numeric_limits<double>::infinity();
    for (int c = 0; c < options_.channels; ++c)
      if (strength[c] > 0) least[0] = std::min(least[0], tolerance[c] / strength[c]);
    BoxQuadrature seen([&](Point2 point) { return Spectrum{{Seen(light, point)}}; },
                       [&](Point2 middle, Vector2 size) { return Falloff(light, middle, size); }, 1);
    const BoxMean unit = seen.Mean(center, box, least);
    mean.value = mean.value + unit.value[0] * strength;
    mean.error = mean.error + unit.error[0] * strength;
  }
  return mean;
}

}  // namespace flatlight
