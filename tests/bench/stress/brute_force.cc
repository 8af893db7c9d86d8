// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/brute_force.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/math/tolerances.h"
#include "core/math/trig.h"
#include "core/plane/intersect.h"
#include "core/scene/element_frame.h"

namespace flatlight::stress {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;

// A direction in which something may begin or end, and by how much it may be off.
struct Break {
  double angle;
  double uncertain;
  Point2 place;
  bool shallow = false;  // Far more uncertain than its coordinates: what is seen may change, though it seems not to.
};

Vector2 BendAt(const Element& element, Point2 place) {
  if (element.kind == Element::Kind::kSegment) return {};
  return element.Orientation() / element.radius * FrontNormal(element, place);
}

class Breaks {
 public:
  Breaks(const Scene& scene, const Receiver& receiver, const Disturbance& disturbance)
      : scene_(scene),
        receiver_(receiver),
        error_(2 * (scene.touch_distance() + scene.coordinate_error() + disturbance.position)),
        turn_(disturbance.direction + 8 * kUnitRoundoff),
        disturbed_(disturbance.position > 0) {
    breaks_ = {{-kHalfPi, turn_, {}}, {kHalfPi, turn_, {}}};
    const std::vector<Element>& elements = scene.elements();
    for (std::size_t i = 0; i < elements.size(); ++i) {
      Add(elements[i].a, error_), Add(elements[i].b, error_);
      if (elements[i].kind == Element::Kind::kArc) AddSilhouettes(elements[i]);
      for (std::size_t j = 0; j < i; ++j) AddMeetings(elements[i], elements[j]);
    }
    std::sort(breaks_.begin(), breaks_.end(), [](const Break& l, const Break& r) { return l.angle < r.angle; });
  }

  const std::vector<Break>& all() const { return breaks_; }

 private:
  void Add(Point2 point, double error, bool shallow = false) {
    const Vector2 to = point - receiver_.position;
    const double angle = std::atan2(Dot(receiver_.tangent, to), Dot(receiver_.normal, to));
    if (std::abs(angle) < kHalfPi)
      breaks_.push_back({angle, std::min(2 * error / Length(to) + turn_, 1.0), point, shallow});
  }

  void AddSilhouettes(const Element& arc) {
    const Vector2 q = receiver_.position - arc.a;
    const Vector2 v = arc.radial_a + q / arc.radius;
    const double height = Dot(q, arc.radial_a) + LengthSquared(q) / (2 * arc.radius);
    // A receiver that is on the circle, to rounding, may see it edge-on.
    const double root = std::sqrt(2 * std::max(height, 0.0) / arc.radius), squared = LengthSquared(v);
    if (height < -error_) return;
    for (const double side : {-1.0, 1.0}) {
      Add(receiver_.position + arc.radius * root / squared * (side * Left(v) - root * v), error_);
    }
  }

  // How far two elements run beside each other, along a unit tangent.
  static double Overlap(const Element& e, const Element& f, Vector2 along) {
    const double ea = Dot(e.a - Point2{}, along), eb = Dot(e.b - Point2{}, along);
    const double fa = Dot(f.a - Point2{}, along), fb = Dot(f.b - Point2{}, along);
    return std::max(0.0, std::min(std::max(ea, eb), std::max(fa, fb)) - std::max(std::min(ea, eb), std::min(fa, fb)));
  }

  // Where two curves cross or touch. A shift by e of one moves the place by e over the sine of the angle between them,
  // but by no more than what takes curves of other curvature a distance e apart.
  void AddMeetings(const Element& e, const Element& f) {
    if (e.carrier == f.carrier) return;
    const auto add = [&](Point2 place, double gap) {
      const Vector2 normal = FrontNormal(e, place);
      const double sine = std::abs(Cross(normal, FrontNormal(f, place)));
      const double bend = Length(BendAt(e, place) - BendAt(f, place));
      const double across = error_ + gap;
      double move = std::min(sine > 0 ? across / sine : 1, Overlap(e, f, Right(normal)));
      if (bend > 0) move = std::min(move, 2 * std::sqrt(across / bend));
      // Disturbed, an end that lies on a curve may come out in front of it.
      Add(place, move + error_, disturbed_ || move > 64 * error_);
    };
    const ElementCrossings common = CrossElements(e, f, 4 * scene_.touch_distance());
    for (int k = 0; k < common.count; ++k) add(common.point[k], 0);
    for (const auto& [one, other] : {std::pair(&e, &f), std::pair(&f, &e)}) {
      for (const Point2 end : {one->a, one->b}) {
        const double gap = DistanceTo(*other, end);
        if (gap < 4 * error_) add(end, gap);
      }
    }
    // Nearly touching: the nearest points lie on the line through the centres, or on the perpendicular.
    const auto near = [&](Point2 place) {
      const double gap = std::max(DistanceTo(e, place), DistanceTo(f, place));
      if (gap < 16 * error_) add(place, gap);
    };
    for (const Element* arc : {&e, &f}) {
      const Element& other = arc == &e ? f : e;
      if (arc->kind != Element::Kind::kArc) continue;
      const Vector2 toward = other.kind == Element::Kind::kArc ? other.center - arc->center : Left(other.b - other.a);
      if (LengthSquared(toward) == 0) continue;
      const Vector2 unit = Normalized(toward);
      for (const double side : {-1.0, 1.0}) near(arc->center + side * arc->radius * unit);
    }
  }

  const Scene& scene_;
  const Receiver& receiver_;
  const double error_;
  const double turn_;
  const bool disturbed_;
  std::vector<Break> breaks_;
};

}  // namespace

BruteIrradiance IrradianceByRays(const Scene& scene, const Receiver& receiver, const Disturbance& disturbance) {
  const Breaks breaks(scene, receiver, disturbance);
  const std::vector<Break>& all = breaks.all();
  double most = 0;
  for (const Curve& curve : scene.curves()) most = std::max(most, curve.radiance[0]);
  BruteIrradiance result;
  // Sines change by the cosine.
  const auto share = [](const Break& at) { return at.uncertain * std::min(1.0, SinCos(at.angle).cos + at.uncertain); };
  double before = 0;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const double middle = 0.5 * (all[i].angle + all[i + 1].angle), half = 0.5 * (all[i + 1].angle - all[i].angle);
    const SinCosValue turn = SinCos(middle);
    const double sines = 2 * turn.cos * SinCos(half).sin;
    // What is so narrow may be wider, or gone.
    const double doubt = all[i].uncertain + all[i + 1].uncertain;
    if (2 * half <= doubt && all[i].place != all[i + 1].place)
      result.uncertain += most * std::min(1.0, turn.cos + doubt) * doubt;
    const Vector2 direction = turn.sin * receiver.tangent + turn.cos * receiver.normal;
    const auto hit = BruteClosestHit(scene, {receiver.position, receiver.element}, direction);
    double radiance = 0;
    if (hit) {
      const Point2 place = receiver.position + hit->distance * direction;
      const bool front = Dot(FrontNormal(scene.element(hit->element), place), direction) < 0;
      radiance = scene.curve_of(hit->element).EmittedRadiance(front ? Side::kFront : Side::kBack)[0];
    }
    result.value += radiance * sines;
    result.uncertain +=
        (all[i].shallow ? most : std::abs(radiance - before)) * share(all[i]) + 4 * kUnitRoundoff * radiance * sines;
    before = radiance;
  }
  result.uncertain += before * share(all.back());
  return result;
}

}  // namespace flatlight::stress
