// SPDX-License-Identifier: Apache-2.0
// Direct light of Bézier curves and segments with 64 bits of mantissa, from the cubics alone: directions at which
// something ends or touches are found by bisection, a ray between each two says what is seen. Nothing is shared with
// the library. For curves that do not cross each other.
#ifndef FLATLIGHT_TESTS_CORE_PLANE_EXACT_BEZIER_ORACLE_H_
#define FLATLIGHT_TESTS_CORE_PLANE_EXACT_BEZIER_ORACLE_H_

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/scene/description.h"

namespace flatlight {

class BezierOracle {
 public:
  using Real = long double;
  struct Vec {
    Real x = 0, y = 0;
  };
  struct Place {
    Vec at, normal, tangent;
  };
  struct Derivatives {
    double irradiance, gradient, hessian;
  };

  explicit BezierOracle(const SceneDescription& scene) {
    for (const CurveDescription& curve : scene.curves) {
      Cubic cubic;
      if (const auto* s = std::get_if<SegmentDescription>(&curve.shape)) {
        const auto mix = [&](Real t) { return Vec{s->a.x + t * (s->b.x - s->a.x), s->a.y + t * (s->b.y - s->a.y)}; };
        cubic = {mix(0), mix(1.0L / 3), mix(2.0L / 3), mix(1)};
      } else {
        const auto& b = std::get<BezierDescription>(curve.shape);
        cubic = {{b.p0.x, b.p0.y}, {b.p1.x, b.p1.y}, {b.p2.x, b.p2.y}, {b.p3.x, b.p3.y}};
      }
      if (curve.emission) cubic.front = curve.emission->radiance[0];
      cubics_.push_back(cubic);
    }
  }

  // By arc length along a curve, at a parameter of it. Nothing where a visibility event is so near that differences of
  // two sizes disagree.
  std::optional<Derivatives> OnCurve(std::size_t curve, Real u, Real side) const {
    const Derivatives wide = Differences(curve, u, side, 1e-3L), narrow = Differences(curve, u, side, 6.5e-4L);
    if (std::abs(wide.hessian - narrow.hessian) > 1e-6 * (1 + std::abs(wide.hessian))) return std::nullopt;
    return narrow;
  }

  Derivatives Differences(std::size_t curve, Real u, Real side, Real h) const {
    Real f[7];
    for (int i = 0; i < 7; ++i) f[i] = Irradiance(PlaceOn(curve, u + (i - 3) * h, side));
    const Real du = (45 * (f[4] - f[2]) - 9 * (f[5] - f[1]) + (f[6] - f[0])) / (60 * h);
    const Real duu = (-49.0L / 18 * f[3] + 1.5L * (f[4] + f[2]) - 0.15L * (f[5] + f[1]) + (f[6] + f[0]) / 90) / (h * h);
    const Vec first = cubics_[curve].First(u), second = cubics_[curve].Second(u);
    const Real speed = std::hypot(first.x, first.y), change = (first.x * second.x + first.y * second.y) / speed;
    const Real gradient = du / speed;
    return {static_cast<double>(f[3]), static_cast<double>(gradient),
            static_cast<double>((duu - change * gradient) / (speed * speed))};
  }

  // The parameter nearest to a point of the curve.
  Real Find(std::size_t curve, double x, double y) const {
    const Cubic& c = cubics_[curve];
    Real best = 0, least = 1e300L;
    for (int i = 0; i <= 4000; ++i) {
      const Vec p = c.At(i / 4000.0L);
      const Real d = std::hypot(p.x - x, p.y - y);
      if (d < least) least = d, best = i / 4000.0L;
    }
    for (int i = 0; i < 30; ++i) {
      const Vec p = c.At(best), f = c.First(best), s = c.Second(best);
      const Real dx = p.x - x, dy = p.y - y;
      best -= (dx * f.x + dy * f.y) / (f.x * f.x + f.y * f.y + dx * s.x + dy * s.y);
    }
    return best;
  }

  Real Irradiance(const Place& place) const {
    std::vector<Real> sines{-1, 1};
    const auto add = [&](Vec p) {
      const Real t = (p.x - place.at.x) * place.tangent.x + (p.y - place.at.y) * place.tangent.y;
      const Real n = (p.x - place.at.x) * place.normal.x + (p.y - place.at.y) * place.normal.y;
      if (n > 0) sines.push_back(t / std::hypot(t, n));
    };
    for (const Cubic& c : cubics_) {
      add(c.At(0)), add(c.At(1));
      const auto turn = [&](Real u) {
        const Vec p = c.At(u), f = c.First(u);
        return (p.x - place.at.x) * f.y - (p.y - place.at.y) * f.x;
      };
      EachRoot(turn, [&](Real u) { add(c.At(u)); });
    }
    std::sort(sines.begin(), sines.end());
    Real sum = 0;
    for (std::size_t i = 0; i + 1 < sines.size(); ++i)
      sum += Seen(place, 0.5L * (sines[i] + sines[i + 1])) * (sines[i + 1] - sines[i]);
    return sum;
  }

  Place PlaceOn(std::size_t curve, Real u, Real side) const {
    const Vec f = cubics_[curve].First(u);
    const Real length = std::hypot(f.x, f.y);
    return {cubics_[curve].At(u), {-side * f.y / length, side * f.x / length}, {f.x / length, f.y / length}};
  }

  Real Length(std::size_t curve, Real from, Real to) const {
    // Simpson's rule.
    const int n = 20000;
    Real sum = 0;
    for (int i = 0; i <= n; ++i) {
      const Vec f = cubics_[curve].First(from + (to - from) * i / n);
      sum += (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) * std::hypot(f.x, f.y);
    }
    return sum * (to - from) / (3 * n);
  }

 private:
  struct Cubic {
    Vec p0, p1, p2, p3;
    Real front = 0;

    Vec At(Real u) const {
      const Real v = 1 - u, a = v * v * v, b = 3 * v * v * u, c = 3 * v * u * u, d = u * u * u;
      return {a * p0.x + b * p1.x + c * p2.x + d * p3.x, a * p0.y + b * p1.y + c * p2.y + d * p3.y};
    }
    Vec First(Real u) const {
      const Real v = 1 - u, a = 3 * v * v, b = 6 * v * u, c = 3 * u * u;
      return {a * (p1.x - p0.x) + b * (p2.x - p1.x) + c * (p3.x - p2.x),
              a * (p1.y - p0.y) + b * (p2.y - p1.y) + c * (p3.y - p2.y)};
    }
    Vec Second(Real u) const {
      const Real v = 6 * (1 - u), w = 6 * u;
      return {v * (p2.x - 2 * p1.x + p0.x) + w * (p3.x - 2 * p2.x + p1.x),
              v * (p2.y - 2 * p1.y + p0.y) + w * (p3.y - 2 * p2.y + p1.y)};
    }
  };

  template <typename F, typename Visit>
  static void EachRoot(const F& f, const Visit& visit) {
    constexpr int kSteps = 97;
    Real u = 0, value = f(u);
    for (int i = 1; i <= kSteps; ++i) {
      const Real next = static_cast<Real>(i) / kSteps, there = f(next);
      if ((value < 0) != (there < 0)) {
        Real low = u, high = next;
        for (int k = 0; k < 70; ++k) {
          const Real middle = 0.5L * (low + high);
          ((f(middle) < 0) == (value < 0) ? low : high) = middle;
        }
        visit(0.5L * (low + high));
      }
      u = next, value = there;
    }
  }

  Real Seen(const Place& place, Real sine) const {
    const Real cosine = std::sqrt(1 - sine * sine);
    const Vec d{sine * place.tangent.x + cosine * place.normal.x, sine * place.tangent.y + cosine * place.normal.y};
    Real nearest = 1e300L, radiance = 0;
    for (const Cubic& c : cubics_) {
      const auto aside = [&](Real u) {
        const Vec p = c.At(u);
        return d.x * (p.y - place.at.y) - d.y * (p.x - place.at.x);
      };
      EachRoot(aside, [&](Real u) {
        const Vec p = c.At(u), f = c.First(u);
        const Real t = d.x * (p.x - place.at.x) + d.y * (p.y - place.at.y);
        if (!(t > 1e-7L) || t >= nearest) return;
        nearest = t;
        radiance = f.x * d.y - f.y * d.x < 0 ? c.front : 0;  // The front, on the left, looks back along the ray.
      });
    }
    return radiance;
  }

  std::vector<Cubic> cubics_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CORE_PLANE_EXACT_BEZIER_ORACLE_H_
