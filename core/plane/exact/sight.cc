// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/sight.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/tolerances.h"

namespace flatlight {
namespace {

constexpr double kRoundoffs = 8 * kUnitRoundoff;

// How far from each other ends may be that touch, to rounding.
double EndDoubt(const Scene& scene) { return std::max(6 * scene.coordinate_error(), 2 * scene.touch_distance()); }

struct Local {
  double tangent, normal;
  Local(double t, double n) : tangent(t), normal(n) {}
  Local(const Receiver& receiver, Point2 point)
      : tangent(Dot(receiver.tangent, point - receiver.position)),
        normal(Dot(receiver.normal, point - receiver.position)) {}
  double Reach() const { return std::abs(tangent) + std::abs(normal); }
};

void SetVertex(const Local& local, Point2 point, double doubt, SightEnd& end) {
  const double inverse = 1 / local.Reach();
  end.tangent = local.tangent, end.normal = local.normal;
  end.key = local.tangent * inverse;
  end.uncertain = doubt * inverse + 2 * kRoundoffs;
  end.point = point;
  end.kind = SightEnd::Kind::kVertex;
  end.crossing = false;
}

void SetHorizon(double sign, SightEnd& end) {
  end = {};
  end.tangent = end.key = sign;
  end.kind = SightEnd::Kind::kHorizon;
}

// The vector between two points, in the receiver's components: to the accuracy of its own length.
Local Between(const Receiver& receiver, Point2 from, Point2 to) {
  const Vector2 v = to - from;
  return {Dot(receiver.tangent, v), Dot(receiver.normal, v)};
}

// Twice the area of the triangle of the receiver and a segment, from whose nearer end nothing cancels.
double Area(const Local& a, const Local& b, const Local& along) {
  const Local& nearer = a.Reach() < b.Reach() ? a : b;
  return nearer.normal * along.tangent - nearer.tangent * along.normal;
}

// What depends on the line through a segment's ends alone, from the lower to the higher one.
inline void SetLine(const Local& a, const Local& b, const Local& along, double area, double coordinate_error,
                    Sight& sight) {
  sight.along_tangent = along.tangent, sight.along_normal = along.normal;
  sight.area = area;
  const double reach_a = a.Reach(), reach_b = b.Reach(), reach_along = along.Reach();
  sight.area_doubt = kRoundoffs * std::min(reach_a, reach_b) * reach_along + 4 * coordinate_error * (reach_a + reach_b);
  // Of a direction, too, the rounding counts.
  sight.along_doubt = 2 * kRoundoffs * reach_along + 4 * coordinate_error;
  const double aa = a.tangent * a.tangent + a.normal * a.normal;
  const double bb = b.tangent * b.tangent + b.normal * b.normal;
  const double ab = a.tangent * b.tangent + a.normal * b.normal;
  sight.far_squared = std::max(aa, bb);
  sight.near_squared = std::min(aa, bb);
  if (ab < sight.near_squared) {
    const double height = std::max(0.0, std::abs(area) - sight.area_doubt);
    const double along_squared = sight.along_tangent * sight.along_tangent + sight.along_normal * sight.along_normal;
    const double spread = std::abs(sight.along_tangent) + std::abs(sight.along_normal) + sight.along_doubt;
    sight.near_squared = height * height / (along_squared + 2 * spread * sight.along_doubt);
  }
}

}  // namespace

Seen SeeSegment(const Scene& scene, const Receiver& receiver, Point2 a, Point2 b, bool left_handed,
                SightBetween& seen) {
  const double coordinate_error = scene.coordinate_error(), touch = scene.touch_distance();
  Local low(receiver, a), high(receiver, b);
  const double doubt_low = touch + 8 * coordinate_error + kRoundoffs * low.Reach();
  const double doubt_high = touch + 8 * coordinate_error + kRoundoffs * high.Reach();
  if (low.normal < -doubt_low && high.normal < -doubt_high) return Seen::kNothing;
  if (std::abs(low.normal) <= doubt_low || std::abs(high.normal) <= doubt_high) return Seen::kDoubt;
  Local along = Between(receiver, a, b);
  double area = Area(low, high, along);
  const bool forward = area > 0;
  if (!forward) {
    std::swap(low, high);
    std::swap(a, b);
    along = {-along.tangent, -along.normal};
    area = -area;
  }
  Sight& sight = seen.sight;
  SetLine(low, high, along, area, coordinate_error, sight);
  // Edge-on, or through the receiver.
  if (!(sight.area > 4 * sight.area_doubt + touch * along.Reach())) return Seen::kDoubt;
  // A part that runs along theta runs clockwise around a receiver whose tangent is on its normal's right, and has it on
  // its right.
  sight.front = forward == left_handed;
  sight.part = nullptr;
  const double doubt = EndDoubt(scene);
  if (low.normal > 0) {
    SetVertex(low, a, doubt, seen.low);
  } else {
    SetHorizon(-1, seen.low);
  }
  if (high.normal > 0) {
    SetVertex(high, b, doubt, seen.high);
  } else {
    SetHorizon(1, seen.high);
  }
  return seen.high.key - seen.low.key > 2 * (seen.low.uncertain + seen.high.uncertain) ? Seen::kPart : Seen::kDoubt;
}

Seen SeePart(const Scene& scene, const Receiver& receiver, const Part& part, bool left_handed, SightBetween& seen) {
  const bool forward = part.first.key < part.last.key;
  const double coordinate_error = scene.coordinate_error();
  const auto set = [&](const Edge& edge, SightEnd& end) {
    end.tangent = edge.tangent, end.normal = edge.normal, end.key = edge.key;
    end.uncertain = edge.kind == Edge::Kind::kHorizon ? 0 : EndDoubt(scene) * edge.q + 2 * kRoundoffs;
    end.edge = &edge;
    end.kind = edge.kind == Edge::Kind::kHorizon ? SightEnd::Kind::kHorizon : SightEnd::Kind::kEdge;
  };
  set(forward ? part.first : part.last, seen.low);
  set(forward ? part.last : part.first, seen.high);
  const Element& element = scene.element(part.element);
  Sight& sight = seen.sight;
  const Local a(receiver, element.a), b(receiver, element.b);
  const Local along = Between(receiver, element.a, element.b);
  const double area = Area(a, b, along);
  if (forward) {
    SetLine(a, b, along, area, coordinate_error, sight);
  } else {
    SetLine(b, a, {-along.tangent, -along.normal}, -area, coordinate_error, sight);
  }
  sight.element = part.element;
  sight.front = forward == left_handed;
  sight.part = nullptr;
  if (part.kind != Part::Kind::kStraight) {
    sight.part = &part;
    // An arc of at most a quarter bulges from its chord by less than a quarter of it.
    const double bulge = 0.25 * Length(element.b - element.a);
    const double near = std::max(0.0, std::sqrt(sight.near_squared) * (1 - kRoundoffs) - bulge);
    const double far = std::sqrt(sight.far_squared) + bulge;
    sight.near_squared = near * near, sight.far_squared = far * far;
  }
  if (part.touches) {
    sight.near_squared = 0;
    return Seen::kDoubt;
  }
  if (part.kind == Part::Kind::kStraight && !(sight.area > 4 * sight.area_doubt)) {
    return Seen::kDoubt;
  }
  return seen.high.key - seen.low.key > 2 * (seen.low.uncertain + seen.high.uncertain) ? Seen::kPart : Seen::kDoubt;
}

}  // namespace flatlight
