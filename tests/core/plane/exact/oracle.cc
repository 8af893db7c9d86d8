// SPDX-License-Identifier: Apache-2.0
#include "tests/core/plane/exact/oracle.h"

#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace flatlight {
namespace {

// Nearer than this, relative to the scene, is the receiver's own curve.
constexpr double kOwnPlace = 1e-20;

const Quad kHalfPi = asinq(1);
constexpr double kFullTurn = 0x1.921fb54442d18p+2;

}  // namespace

Oracle::Oracle(const SceneDescription& scene) {
  double low = 1e300, high = -1e300;
  for (const CurveDescription& curve : scene.curves) {
    Quad radiance = 0;
    if (curve.emission) radiance = curve.emission->radiance[0];
    const auto add = [&](Line line) {
      line.front = radiance;
      line.back = curve.emission && curve.emission->two_sided ? radiance : 0;
      lines_.push_back(line);
    };
    const auto segment = [&](Point2 a, Point2 b) {
      Line line;
      line.ax = a.x, line.ay = a.y, line.bx = b.x, line.by = b.y;
      add(line);
      low = std::min({low, a.x, a.y, b.x, b.y}), high = std::max({high, a.x, a.y, b.x, b.y});
    };
    if (const auto* s = std::get_if<SegmentDescription>(&curve.shape)) {
      segment(s->a, s->b);
    } else if (const auto* p = std::get_if<PolylineDescription>(&curve.shape)) {
      for (std::size_t i = 0; i + 1 < p->points.size() + (p->closed ? 1 : 0); ++i)
        segment(p->points[i], p->points[(i + 1) % p->points.size()]);
    } else {
      const auto& arc = std::get<ArcDescription>(curve.shape);
      Line line;
      line.arc = true;
      line.cx = arc.center.x, line.cy = arc.center.y, line.radius = arc.radius;
      line.start = arc.start_angle, line.sweep = arc.sweep_angle;
      // 2 pi in 53 bits says a full circle, which closes.
      if (std::abs(arc.sweep_angle) >= kFullTurn) line.sweep = arc.sweep_angle > 0 ? 4 * kHalfPi : -4 * kHalfPi;
      add(line);
      low = std::min({low, arc.center.x, arc.center.y}), high = std::max({high, arc.center.x, arc.center.y});
    }
  }
  scale_ = high - low;
}

Quad Oracle::Hit(const Line& line, const Place& place, Quad dx, Quad dy, bool* front) const {
  const Quad least = scale_ * static_cast<Quad>(kOwnPlace);
  if (!line.arc) {
    const Quad ex = line.bx - line.ax, ey = line.by - line.ay;
    const Quad fx = line.ax - place.x, fy = line.ay - place.y;
    const Quad denominator = dx * ey - dy * ex;
    if (denominator == 0) return -1;
    const Quad t = (fx * ey - fy * ex) / denominator;
    const Quad u = (fx * dy - fy * dx) / denominator;
    if (!(t > least && u >= 0 && u <= 1)) return -1;
    *front = (ex * (place.y - line.ay) - ey * (place.x - line.ax)) > 0;
    return t;
  }
  const Quad fx = place.x - line.cx, fy = place.y - line.cy;
  const Quad b = fx * dx + fy * dy;
  const Quad c = fx * fx + fy * fy - line.radius * line.radius;
  const Quad discriminant = b * b - c;
  if (discriminant < 0) return -1;
  const Quad turn = 4 * kHalfPi;
  for (const Quad t : {-b - sqrtq(discriminant), -b + sqrtq(discriminant)}) {
    if (!(t > least)) continue;
    Quad angle = atan2q(fy + t * dy, fx + t * dx) - line.start;
    if (line.sweep < 0) angle = -angle;
    angle -= turn * floorq(angle / turn);
    if (angle > fabsq(line.sweep)) continue;
    const bool from_inside = (fx + t * dx) * dx + (fy + t * dy) * dy > 0;
    *front = (line.sweep > 0) == from_inside;
    return t;
  }
  return -1;
}

Quad Oracle::Irradiance(const Place& place, Quad* size) const {
  std::vector<Quad> angles{-kHalfPi, kHalfPi};
  const auto add = [&](Quad px, Quad py) {
    const Quad dx = px - place.x, dy = py - place.y;
    const Quad angle = atan2q(dx * place.tx + dy * place.ty, dx * place.nx + dy * place.ny);
    if (fabsq(angle) < kHalfPi) angles.push_back(angle);
  };
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    if (!line.arc) {
      add(line.ax, line.ay), add(line.bx, line.by);
    } else {
      for (const Quad angle : {line.start, line.start + line.sweep})
        add(line.cx + line.radius * cosq(angle), line.cy + line.radius * sinq(angle));
      const Quad fx = place.x - line.cx, fy = place.y - line.cy, distance = hypotq(fx, fy);
      if (distance > line.radius) {
        const Quad middle = atan2q(fy, fx), half = acosq(line.radius / distance);
        for (const Quad angle : {middle - half, middle + half})
          add(line.cx + line.radius * cosq(angle), line.cy + line.radius * sinq(angle));
      }
    }
    // Crossings of every two carriers, on the curves or not.
    for (std::size_t j = 0; j < i; ++j) {
      const Line& other = lines_[j];
      if (!line.arc && !other.arc) {
        const Quad ex = line.bx - line.ax, ey = line.by - line.ay, gx = other.bx - other.ax, gy = other.by - other.ay;
        const Quad d = ex * gy - ey * gx;
        if (d == 0) continue;
        const Quad t = ((other.ax - line.ax) * gy - (other.ay - line.ay) * gx) / d;
        add(line.ax + t * ex, line.ay + t * ey);
      } else if (line.arc && other.arc) {
        const Quad ex = other.cx - line.cx, ey = other.cy - line.cy, d2 = ex * ex + ey * ey;
        if (d2 == 0) continue;
        const Quad a = (d2 + line.radius * line.radius - other.radius * other.radius) / (2 * d2);
        const Quad h2 = line.radius * line.radius / d2 - a * a;
        if (h2 < 0) continue;
        for (const Quad h : {-sqrtq(h2), sqrtq(h2)}) add(line.cx + a * ex - h * ey, line.cy + a * ey + h * ex);
      } else {
        const Line& arc = line.arc ? line : other;
        const Line& straight = line.arc ? other : line;
        const Quad ex = straight.bx - straight.ax, ey = straight.by - straight.ay;
        const Quad fx = straight.ax - arc.cx, fy = straight.ay - arc.cy;
        const Quad a = ex * ex + ey * ey, b = ex * fx + ey * fy, c = fx * fx + fy * fy - arc.radius * arc.radius;
        const Quad d = b * b - a * c;
        if (d < 0) continue;
        for (const Quad t : {(-b - sqrtq(d)) / a, (-b + sqrtq(d)) / a}) add(straight.ax + t * ex, straight.ay + t * ey);
      }
    }
  }
  std::sort(angles.begin(), angles.end());
  Quad sum = 0;
  for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
    const Quad middle = (angles[i] + angles[i + 1]) / 2;
    const Quad dx = cosq(middle) * place.nx + sinq(middle) * place.tx;
    const Quad dy = cosq(middle) * place.ny + sinq(middle) * place.ty;
    Quad nearest = -1, radiance = 0;
    for (const Line& line : lines_) {
      bool front = false;
      const Quad t = Hit(line, place, dx, dy, &front);
      if (t > 0 && (nearest < 0 || t < nearest)) nearest = t, radiance = front ? line.front : line.back;
    }
    sum += radiance * (sinq(angles[i + 1]) - sinq(angles[i]));
    if (size) *size += radiance * (fabsq(sinq(angles[i])) + fabsq(sinq(angles[i + 1])));
  }
  return sum;
}

template <typename PlaceAt>
std::optional<OracleValue> Oracle::Differentiate(PlaceAt place_at) const {
  Quad size = 0;
  const Quad e0 = Irradiance(place_at(Quad(0)), &size);
  // Central differences of fourth order at two steps: they agree unless an event is near.
  const auto differences = [&](Quad h, Quad* first, Quad* second) {
    const Quad m2 = Irradiance(place_at(-2 * h), nullptr), m1 = Irradiance(place_at(-h), nullptr);
    const Quad p1 = Irradiance(place_at(h), nullptr), p2 = Irradiance(place_at(2 * h), nullptr);
    *first = (m2 - 8 * m1 + 8 * p1 - p2) / (12 * h);
    *second = (-m2 + 16 * m1 - 30 * e0 + 16 * p1 - p2) / (12 * h * h);
  };
  Quad first, second, first_half, second_half;
  const Quad h = scale_ * static_cast<Quad>(1e-6);
  differences(h, &first, &second);
  differences(h / 2, &first_half, &second_half);
  const Quad agree1 = fabsq(first - first_half) * scale_, agree2 = fabsq(second - second_half) * scale_ * scale_;
  if (agree1 > static_cast<Quad>(1e-14) * (size + fabsq(first) * scale_) ||
      agree2 > static_cast<Quad>(1e-11) * (size + fabsq(second) * scale_ * scale_))
    return std::nullopt;
  return OracleValue{static_cast<double>(e0), static_cast<double>(first_half), static_cast<double>(second_half),
                     static_cast<double>(size)};
}

std::optional<OracleValue> Oracle::OnCurve(std::size_t curve, double fraction, Side side) const {
  const Line& line = lines_[curve];
  const Quad sign = side == Side::kFront ? 1 : -1;
  return Differentiate([&](Quad step) {
    Place place;
    if (line.arc) {
      const Quad angle = line.start + fraction * line.sweep + step / line.radius * (line.sweep > 0 ? 1 : -1);
      const Quad turn = line.sweep > 0 ? 1 : -1;
      place.x = line.cx + line.radius * cosq(angle), place.y = line.cy + line.radius * sinq(angle);
      place.tx = -turn * sinq(angle), place.ty = turn * cosq(angle);
    } else {
      const Quad ex = line.bx - line.ax, ey = line.by - line.ay, length = hypotq(ex, ey);
      place.tx = ex / length, place.ty = ey / length;
      place.x = line.ax + fraction * ex + step * place.tx, place.y = line.ay + fraction * ey + step * place.ty;
    }
    place.nx = -sign * place.ty, place.ny = sign * place.tx;
    return place;
  });
}

std::optional<OracleValue> Oracle::AtPoint(Point2 position, Vector2 normal) const {
  const Quad nx = normal.x, ny = normal.y, length = hypotq(nx, ny);
  return Differentiate([&](Quad step) {
    Place place;
    place.nx = nx / length, place.ny = ny / length;
    place.tx = place.ny, place.ty = -place.nx;
    place.x = position.x + step * place.tx, place.y = position.y + step * place.ty;
    return place;
  });
}

}  // namespace flatlight
