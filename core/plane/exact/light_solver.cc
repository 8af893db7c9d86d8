// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/light_solver.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/math/tolerances.h"
#include "core/math/trig.h"

namespace flatlight {
namespace {

// A function of arc length with its first two derivatives.
struct Jet {
  double value = 0;
  double first = 0;
  double second = 0;
};

Jet operator*(const Jet& f, const Jet& g) {
  return {f.value * g.value, f.first * g.value + f.value * g.first,
          f.second * g.value + 2 * f.first * g.first + f.value * g.second};
}

// cos(theta) / distance of a light of unit intensity, as the receiver moves.
Jet Falloff(Vector2 toward, const Receiver& receiver) {
  const double kappa = receiver.curvature;
  const double a = Dot(receiver.normal, toward), tau = Dot(receiver.tangent, toward);
  const double q = 1 / LengthSquared(toward);
  const double a1 = -kappa * tau, a2 = kappa - kappa * kappa * a - receiver.curvature_change * tau;
  return {a * q, a1 * q + 2 * a * tau * q * q,
          a2 * q + 4 * a1 * tau * q * q + a * (2 * (kappa * a - 1) * q * q + 8 * tau * tau * q * q * q)};
}

// The share of a spot's intensity that goes to the receiver, as it moves.
Jet Share(const PointLight& light, Vector2 toward, const Receiver& receiver) {
  const double width = light.edge_angle - light.cone_angle;
  const Vector2 along = -toward;
  const double side = Cross(light.axis, along);
  const double angle = AngleOf(Dot(light.axis, along), std::abs(side));
  if (angle <= light.cone_angle) return {1, 0, 0};
  if (angle >= light.edge_angle) return {};
  // The angle's own derivatives: it grows away from the axis.
  const double sign = side < 0 ? -1 : 1;
  const double q = 1 / LengthSquared(along);
  const double turn = Cross(along, receiver.tangent);
  const double angle1 = sign * turn * q;
  const double angle2 =
      sign * (receiver.curvature * Cross(along, receiver.normal) * q - 2 * turn * Dot(along, receiver.tangent) * q * q);
  const double t = (light.edge_angle - angle) / width;
  const double step1 = -6 * t * (1 - t) / width, step2 = 6 * (1 - 2 * t) / (width * width);
  return {t * t * (3 - 2 * t), step1 * angle1, step2 * angle1 * angle1 + step1 * angle2};
}

}  // namespace

void LightSolver::Add(const Receiver& receiver, ExactValue& value) const {
  for (const Light& light : caster_.scene().lights()) {
    if (const auto* point = std::get_if<PointLight>(&light.kind)) {
      AddPoint(*point, receiver, value);
    } else {
      AddDirectional(std::get<DirectionalLight>(light.kind), receiver, value);
    }
  }
}

void LightSolver::AddPoint(const PointLight& light, const Receiver& receiver, ExactValue& value) const {
  const Vector2 toward = light.position - (receiver.position + receiver.offset);
  const double distance = Length(toward);
  if (!(Dot(receiver.normal, toward) > 0)) return;
  if (!caster_.Visible({receiver.position, receiver.element}, {light.position, ElementId::kNone})) return;
  Jet jet = Falloff(toward, receiver);
  const bool spot = light.cone_angle < 0x1.921fb54442d18p+1;
  if (spot) jet = jet * Share(light, toward, receiver);
  // What the receiver's place is uncertain by turns the direction and changes the distance; each derivative divides by
  // the shortest length there is (the distance, the radius of curvature, the width of the spot's edge).
  const double width = spot ? std::min(1.0, light.edge_angle - light.cone_angle) : 1;
  const double uncertain = 4 * caster_.scene().coordinate_error() / (distance * width) + 32 * kUnitRoundoff / width;
  const double steep = 2 * (1 / (distance * width) + std::abs(receiver.curvature));
  const double size = 1 / distance;
  AddRotation(light.intensity,
              (spot ? light.Share(-toward) : 1) * Dot(receiver.tangent, toward) / (distance * distance),
              size * uncertain, value);
  AddTimes(light.intensity, {jet.value, jet.first, jet.second},
           {size * uncertain, 2 * size * steep * uncertain, 4 * size * steep * steep * uncertain}, value);
}

void LightSolver::AddDirectional(const DirectionalLight& light, const Receiver& receiver, ExactValue& value) const {
  const Vector2 toward = -light.direction;
  const double cosine = Dot(receiver.normal, toward), sine = Dot(receiver.tangent, toward);
  if (!(cosine > 0)) return;
  if (caster_.ClosestHit({receiver.position, receiver.element}, toward).has_value()) return;
  const double kappa = receiver.curvature;
  const double uncertain = 16 * kUnitRoundoff + 4 * std::abs(kappa) * caster_.scene().coordinate_error();
  AddRotation(light.irradiance, sine, uncertain, value);
  AddTimes(light.irradiance, {cosine, -kappa * sine, -kappa * kappa * cosine - receiver.curvature_change * sine},
           {uncertain, std::abs(kappa) * uncertain, kappa * kappa * uncertain}, value);
}

void LightSolver::AddRotation(const Spectrum& strength, double rotation, double error, ExactValue& value) const {
  if (options_.derivatives < 1) return;
  value.rotation = value.rotation + rotation * strength;
  value.rotation_error = value.rotation_error + error * strength;
}

void LightSolver::AddTimes(const Spectrum& strength, const double (&unit)[3], const double (&error)[3],
                           ExactValue& value) const {
  const auto add = [&](double factor, Spectrum& sum) { sum = sum + factor * strength; };
  add(unit[0], value.irradiance);
  add(error[0], value.irradiance_error);
  if (options_.derivatives >= 1) {
    add(unit[1], value.gradient);
    add(error[1], value.gradient_error);
  }
  if (options_.derivatives >= 2) {
    add(unit[2], value.hessian);
    add(error[2], value.hessian_error);
  }
}

}  // namespace flatlight
