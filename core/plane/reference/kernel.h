// SPDX-License-Identifier: Apache-2.0
// Light from a point of an element to a receiver, and how it changes as the receiver moves.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_KERNEL_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_KERNEL_H_

#include <cmath>

#include "core/math/vec.h"
#include "core/plane/reference/chart.h"
#include "core/scene/scene.h"

namespace flatlight {

// A pair of points: d = y - x, tau = t.d, A = n.d, B = -n_y.d, Q = d.d. Irradiance per radiance and length of the
// emitter is A B Q^(-3/2).
class Kernel {
 public:
  // `radius`: of the circle that both lie on, inside, with the receiver's own curvature; 0 if they don't.
  Kernel(const Receiver& receiver, const Chart::Place& place, Side side, double radius) : receiver_(receiver) {
    const Vector2 d = place.position - receiver.position;
    const double sign = side == Side::kFront ? 1 : -1;
    emitter_normal_ = sign * Left(place.tangent);
    tau_ = Dot(receiver.tangent, d);
    q_ = LengthSquared(d);
    a_ = Dot(receiver.normal, d);
    b_ = -Dot(emitter_normal_, d);
    root_ = std::sqrt(q_);
    if (radius != 0) half_curvature_ = 0.5 / radius;
  }

  // On one circle A = B = Q/(2 R), so the value is r/(4 R^2), 0 at the receiver itself.
  double Value() const {
    return half_curvature_ != 0 ? half_curvature_ * half_curvature_ * root_ : a_ * b_ / (q_ * root_);
  }

  struct Derivatives {
    double first = 0;
    double second = 0;
  };
  // Along the receiver's tangent.
  Derivatives Derive() const {
    if (half_curvature_ != 0) {
      // r' = -sin theta, sin' theta = r/(4 R^2).
      const double h = half_curvature_, sine = root_ > 0 ? tau_ / root_ : 0;
      return {-h * h * sine, -h * h * h * h * root_};
    }
    const double k = receiver_.curvature;
    const double u = 1 / (q_ * root_), u5 = u / q_, u7 = u5 / q_;
    const double a1 = -k * tau_, a2 = -k * k * a_ + k - receiver_.curvature_change * tau_;
    const double b1 = Dot(emitter_normal_, receiver_.tangent), b2 = k * Dot(emitter_normal_, receiver_.normal);
    const double u1 = 3 * tau_ * u5, u2 = 3 * (k * a_ - 1) * u5 + 15 * tau_ * tau_ * u7;
    const double p = a_ * b_, p1 = a1 * b_ + a_ * b1, p2 = a2 * b_ + 2 * a1 * b1 + a_ * b2;
    return {p1 * u + p * u1, p2 * u + 2 * p1 * u1 + p * u2};
  }

 private:
  const Receiver& receiver_;
  Vector2 emitter_normal_;
  double tau_, a_, b_, q_, root_;
  double half_curvature_ = 0;  // 1/(2 R) of their one circle; 0 if there is none.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_KERNEL_H_
