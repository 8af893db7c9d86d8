// SPDX-License-Identifier: Apache-2.0
// How the direction of a break in what a receiver sees moves as the receiver does.
#ifndef FLATLIGHT_CORE_PLANE_RAY_TRACING_BREAK_LAW_H_
#define FLATLIGHT_CORE_PLANE_RAY_TRACING_BREAK_LAW_H_

namespace flatlight {

// A break: a fixed point, or the silhouette of an arc. Angles from the receiver's normal toward its tangent.
struct Break {
  double sine = 0;
  double cosine = 1;
  double inverse_distance = 0;  // Of the point, or of where the ray touches the arc. 0: infinitely far.
  double turn =
      0;  // Silhouettes: radius, positive if the arc's centre lies toward greater angles. 0 for a fixed point.
};

// First and second derivative of the sine of a break's direction per arc length along a receiver of curvature kappa,
// whose derivative is 0 (THEORY 6.3 and 18 B1).
struct BreakMotion {
  double first = 0;
  double second = 0;
};

inline BreakMotion MotionOf(const Break& at, double kappa) {
  const double s = at.sine, c = at.cosine, q = at.inverse_distance;
  const double cq = c * q;
  return {kappa * c - c * cq, s * (kappa * (3 * cq - kappa) - 3 * cq * cq) - at.turn * (cq * cq * cq)};
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_RAY_TRACING_BREAK_LAW_H_
