// SPDX-License-Identifier: Apache-2.0
#include "core/scene/bezier_chain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/tolerances.h"
#include "core/math/trig.h"

namespace flatlight {
namespace {

// Arcs turn by less, so that a pair of them follows the curve.
constexpr double kMostTurn = 0.5;  // rad
// Arcs of one run turn by less than half a turn in all: from one of them, the others are on one side.
constexpr double kMostTurnOfRun = 3;  // rad
// Radii beyond so many lengths of an arc are straight: it bulges by 1e-9 of its length.
constexpr double kStraight = 1e8;
// Places of a pair of arcs at which its distance from the curve is measured. It is a smooth function between the ends,
// so the largest value among these is within a few percent of the largest of all; kMargin makes up for that.
constexpr int kPlaces = 15;
constexpr double kMargin = 1.25;
// Of a stretch without an inflection, and the share of the tolerance that a step is made for.
constexpr double kFirstStep = 0.1;
constexpr double kAim = 0.8;
// A stretch that short is a point of a cusp.
constexpr double kLeastStep = 0x1p-40;
constexpr double kNoPair = std::numeric_limits<double>::infinity();

// From a to b, along `tangent` at a and `tangent_b` at b, which meet at the distance `reach` from both.
Element ArcBetween(Point2 a, Vector2 tangent, Point2 b, Vector2 tangent_b, double reach) {
  Element arc;
  arc.a = a, arc.b = b;
  const double sine = Cross(tangent, tangent_b), cosine = Dot(tangent, tangent_b);
  const double chord = Length(b - a);
  // Of half the turn.
  const double half = std::abs(sine) / (1 + cosine);
  if (!(half * kStraight > reach / chord)) return arc;
  const double sign = sine > 0 ? 1 : -1;
  arc.kind = Element::Kind::kArc;
  arc.radius = reach / half;
  arc.sweep_angle = sign * 2 * AngleOf(1 + cosine, std::abs(sine));
  arc.radial_a = sign * Right(tangent);
  arc.radial_b = sign * Right(tangent_b);
  arc.center = a - arc.radius * arc.radial_a;
  return arc;
}

// From the piece to a point, along its left normal at the piece; and the tangent there.
struct Beside {
  double distance;
  Vector2 tangent;
  Vector2 normal;
};

Beside LookFrom(const Element& element, Point2 point) {
  const Vector2 from_a = point - element.a;
  if (element.kind == Element::Kind::kSegment) {
    const Vector2 tangent = Normalized(element.b - element.a);
    return {Cross(tangent, from_a), tangent, Left(tangent)};
  }
  const Vector2 v = element.radial_a + from_a / element.radius;
  const double length = Length(v), turn = element.Orientation();
  const double outside = (2 * Dot(from_a, element.radial_a) + LengthSquared(from_a) / element.radius) / (1 + length);
  return {-turn * outside, (turn / length) * Left(v), (-turn / length) * v};
}

// Of a number from 0 to 1000, roughly. The C library's is not the same on every machine.
double CubeRoot(double x) {
  double root = 10;
  for (int i = 0; i < 30; ++i) root -= (root - x / (root * root)) / 3;
  return root;
}

class ChainMaker {
 public:
  ChainMaker(const Bezier& bezier, double tolerance) : bezier_(bezier), tolerance_(tolerance) {}

  BezierChain Make() {
    if (bezier_.IsStraight()) {
      AddStraight();
      return std::move(chain_);
    }
    const Roots inflections = bezier_.Inflections();
    double from = 0;
    for (int i = 0; i <= inflections.count; ++i) {
      const double to = i < inflections.count ? inflections.at[i] : 1;
      if (to > from) Add(from, to);
      from = to;
    }
    NumberRuns();
    return std::move(chain_);
  }

 private:
  // One that may turn back on its line.
  void AddStraight() {
    Vector2 along;
    for (const Point2& a : bezier_.p)
      for (const Point2& b : bezier_.p)
        if (LengthSquared(b - a) > LengthSquared(along)) along = b - a;
    const double a = Dot(along, bezier_.p[1] - bezier_.p[0]), b = Dot(along, bezier_.p[2] - bezier_.p[1]),
                 c = Dot(along, bezier_.p[3] - bezier_.p[2]);
    const Roots turns = QuadraticRoots(a, 2 * (b - a), a - 2 * b + c);
    double from = 0;
    for (int i = 0; i <= turns.count; ++i) {
      const double to = i < turns.count ? turns.at[i] : 1;
      AddSegment(from, to);
      from = to;
    }
  }

  void AddSegment(double from, double to) {
    BezierChain::Piece piece;
    piece.element.a = bezier_.At(from), piece.element.b = bezier_.At(to);
    piece.on.from = from, piece.on.to = to;
    // A cusp's tip is longer than its chord.
    const bool straight = bezier_.IsStraight();
    piece.element.length = straight ? Length(piece.element.b - piece.element.a) : bezier_.Length(from, to);
    if (piece.element.a != piece.element.b) chain_.pieces.push_back(piece);
  }

  // As long steps as the tolerance allows: the distance of a pair grows by the third power of its step.
  void Add(double from, double to) {
    double step = kFirstStep * (to - from);
    while (from < to) {
      // The rest in equal steps, so that none is far shorter than it might be.
      double next = from + (to - from) / std::max(1.0, std::ceil((to - from) / step * (1 - 1e-9)));
      if (to - next < kLeastStep) next = to;
      const double distance = AddPair(from, next);
      const double growth = CubeRoot(kAim * tolerance_ / std::max(distance, 1e-3 * tolerance_));
      if (distance <= tolerance_) {
        step = (next - from) * std::clamp(growth, 0.5, 4.0);
        from = next;
      } else if (next - from <= kLeastStep || IsSmall(from, next)) {
        AddSegment(from, next);
        from = next;
      } else {
        step = (next - from) * std::clamp(growth, 0.25, 0.8);
      }
    }
  }

  // No part of the stretch is farther from its ends than half of the tolerance: the tip of a cusp.
  bool IsSmall(double from, double to) const {
    const double third = (to - from) / 3;
    const Point2 a = bezier_.At(from), b = bezier_.At(to);
    const Vector2 first = third * bezier_.First(from), last = third * bezier_.First(to);
    const double least = 0.25 * tolerance_;
    return std::max({Length(b - a), Length(first), Length(last)}) <= least;
  }

  // How far the pair of arcs is from the curve; it is added if that is within the tolerance.
  double AddPair(double from, double to) {
    const Point2 a = bezier_.At(from), b = bezier_.At(to);
    const Vector2 tangent_a = bezier_.Tangent(from, 1), tangent_b = bezier_.Tangent(to, -1);
    const Vector2 v = b - a;
    const double across = Dot(v, tangent_a + tangent_b), squared = LengthSquared(v);
    if (!(Dot(tangent_a, tangent_b) > 0.7) || !(across > 1.5 * std::sqrt(squared))) return kNoPair;
    const double reach =
        squared / (across + std::sqrt(across * across + squared * LengthSquared(tangent_a - tangent_b)));
    const Point2 corner_a = a + reach * tangent_a, corner_b = b - reach * tangent_b;
    const Vector2 tangent = Normalized(corner_b - corner_a);
    const Point2 joint = corner_a + 0.5 * (corner_b - corner_a);
    BezierChain::Piece first, second;
    first.element = ArcBetween(a, tangent_a, joint, tangent, reach);
    second.element = ArcBetween(joint, tangent, b, tangent_b, reach);
    for (const Element* arc : {&first.element, &second.element})
      if (std::abs(arc->sweep_angle) > kMostTurn) return kNoPair;
    // Where the curve passes the joint.
    double low = from, high = to;
    for (int i = 0; i < 60; ++i) {
      const double u = 0.5 * (low + high);
      if (!(low < u && u < high)) break;
      (Dot(bezier_.At(u) - joint, tangent) < 0 ? low : high) = u;
    }
    first.on.from = from, first.on.to = second.on.from = high, second.on.to = to;
    if (!Measure(from, high, first) || !Measure(high, to, second)) return kNoPair;
    const double distance = std::max(first.on.distance, second.on.distance);
    if (distance <= tolerance_) chain_.pieces.push_back(first), chain_.pieces.push_back(second);
    return distance;
  }

  // False if the curve goes another way.
  bool Measure(double from, double to, BezierChain::Piece& piece) const {
    piece.on.bends = true;
    for (int i = 0; i <= kPlaces; ++i) {
      const double u = from + (to - from) * i / kPlaces;
      const Beside beside = LookFrom(piece.element, bezier_.At(u));
      const Vector2 tangent = bezier_.Tangent(u, i == 0 ? 1 : -1);
      if (!(Dot(tangent, beside.tangent) > 0.9)) return false;
      piece.on.distance = std::max(piece.on.distance, kMargin * std::abs(beside.distance));
      piece.on.tilt = std::max(piece.on.tilt, kMargin * std::abs(Cross(tangent, beside.tangent)));
    }
    piece.element.length = bezier_.Length(from, to);
    return true;
  }

  void NumberRuns() {
    std::uint32_t run = 0;
    double turned = 0;
    for (std::size_t i = 0; i < chain_.pieces.size(); ++i) {
      BezierChain::Piece& piece = chain_.pieces[i];
      const double turn = piece.element.kind == Element::Kind::kArc ? piece.element.sweep_angle : 0;
      const bool goes_on = i > 0 && turn * turned > 0 && std::abs(turned + turn) < kMostTurnOfRun &&
                           chain_.pieces[i - 1].on.bends &&
                           Dot(chain_.pieces[i - 1].element.radial_b, piece.element.radial_a) > 0.5;
      if (!goes_on) ++run, turned = 0;
      turned += turn;
      piece.on.run = run;
    }
  }

  const Bezier& bezier_;
  const double tolerance_;
  BezierChain chain_;
};

}  // namespace

BezierChain MakeBezierChain(const Bezier& bezier, double tolerance) { return ChainMaker(bezier, tolerance).Make(); }

void PlaceOnBezier(const Element& element, const Bezier& bezier, double u, double sign, Receiver& receiver) {
  const Point2 place = bezier.At(u);
  const Beside beside = LookFrom(element, place);
  receiver.position = place - beside.distance * beside.normal;
  receiver.offset = place - receiver.position;
  receiver.tangent = bezier.Tangent(u, 1);
  receiver.normal = sign * Left(receiver.tangent);
  receiver.curvature = sign * bezier.Curvature(u);
  receiver.curvature_change = sign * bezier.CurvatureChange(u);
  receiver.curvature_second = sign * bezier.CurvatureChangeChange(u);
}

void BoundPlaceOnBezier(const Bezier& bezier, double u, double along, double coordinate_error, Receiver& receiver) {
  const Vector2 first = bezier.First(u), second = bezier.Second(u), third = bezier.Third();
  const double f = Length(first), s = Length(second), t = Length(third);
  // The terms that the derivatives are sums of round to their own sizes: where the curve all but stands still, these
  // are what counts.
  const double a = Length(bezier.p[1] - bezier.p[0]), b = Length(bezier.p[2] - bezier.p[1]),
               c = Length(bezier.p[3] - bezier.p[2]), v = 1 - u;
  constexpr double kRoundoffs = 8 * kUnitRoundoff;
  const double df = 6 * coordinate_error + kRoundoffs * 3 * (v * v * a + 2 * u * v * b + u * u * c);
  const double ds = 24 * coordinate_error + kRoundoffs * 6 * (v * (a + b) + u * (b + c));
  const double dt = 48 * coordinate_error + kRoundoffs * 6 * (a + 2 * b + c);
  const double k = std::abs(receiver.curvature), change = std::abs(receiver.curvature_change);
  const double squared = f * f, cross = k * squared * f, dcross = df * s + f * ds;
  const double place = along + 4 * kUnitRoundoff * f;
  receiver.displaced = place;
  receiver.tilt = 2 * (df / f + k * place);
  receiver.curvature_error = 2 * (dcross / (squared * f) + 3 * k * df / f + change * place);
  const double dproduct = dcross * s / f + cross * dcross / squared + 2 * cross * s / f * df / f;
  receiver.curvature_change_error = 2 * ((df * t + f * dt + 3 * dproduct) / (squared * squared) + 4 * change * df / f +
                                         std::abs(receiver.curvature_second) * place);
}

double NearestOnBezier(const Bezier& bezier, Point2 point, double low, double high, double guess) {
  double u = std::clamp(guess, low, high);
  for (int i = 0; i < 20; ++i) {
    const Vector2 d = bezier.At(u) - point, first = bezier.First(u);
    const double slope = LengthSquared(first) + Dot(d, bezier.Second(u));
    if (!(slope > 0)) break;
    const double next = std::clamp(u - Dot(d, first) / slope, low, high);
    if (std::abs(next - u) <= 2 * kUnitRoundoff) return next;
    u = next;
  }
  return u;
}

}  // namespace flatlight
