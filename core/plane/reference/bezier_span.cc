// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/bezier_span.h"

#include <algorithm>
#include <cmath>

#include "core/plane/chains/beam_cuts.h"
#include "core/scene/bezier_chain.h"

namespace flatlight {
namespace {

// Lines that a family adds on either side meet what is so far beyond the ends, as part of the stretch.
constexpr double kBeyond = 1e-6;
// A polynomial through the offsets of touching lines is good if it is that near; shorter parts, of the family, are
// taken as they are.
constexpr double kOffset = 1e-11, kLeastPart = 1e-7;
constexpr double kRootWithin = 1e-3;  // Of a part.

// A Bézier's stretch as one of its own.
Bezier PartOf(const Bezier& bezier, double from, double to) {
  const double third = (to - from) / 3;
  const Point2 a = bezier.At(from), b = bezier.At(to);
  return {{a, a + third * bezier.First(from), b - third * bezier.First(to), b}};
}

// Numbers that Bézier's control points give along a direction, or across it.
struct Cubic {
  double c[4];

  double At(double v) const {
    const double w = 1 - v;
    return w * w * (w * c[0] + 3 * v * c[1]) + v * v * (3 * w * c[2] + v * c[3]);
  }
  double SlopeAt(double v) const {
    const double w = 1 - v;
    return 3 * (w * w * (c[1] - c[0]) + 2 * v * w * (c[2] - c[1]) + v * v * (c[3] - c[2]));
  }
};

// Of a + b v + c v^2, in order.
Roots AllRoots(double a, double b, double c) {
  Roots roots;
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant >= 0)) {
    // The place of a double root that rounding took away.
    if (c != 0 && discriminant > -1e-12 * b * b) roots.at[roots.count++] = -0.5 * b / c;
    return roots;
  }
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  if (c != 0) roots.at[roots.count++] = q / c;
  if (q != 0) roots.at[roots.count++] = a / q;
  if (roots.count == 2 && roots.at[0] > roots.at[1]) std::swap(roots.at[0], roots.at[1]);
  return roots;
}

Roots StandsOf(const Cubic& f) {
  const double d0 = f.c[1] - f.c[0], d1 = f.c[2] - f.c[1], d2 = f.c[3] - f.c[2];
  return AllRoots(d0, 2 * (d1 - d0), d0 - 2 * d1 + d2);
}

// Of a function that has different signs at the ends: Newton's method, kept between them.
double RootBetween(const Cubic& f, double low, double high, double at_low, double at_high) {
  // As it starts on a straight line a parabola has its root nearer to the end where it is steep.
  double v = low + (high - low) * at_low / (at_low - at_high);
  const bool rises = at_high > at_low;
  double before = high - low;
  for (int i = 0; i < 60; ++i) {
    const double value = f.At(v);
    ((value > 0) == rises ? high : low) = v;
    const double step = -value / f.SlopeAt(v);
    double next = v + step;
    if (next == v) break;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double moved = std::abs(next - v);
    v = next;
    // Steps that no longer shrink are rounding.
    if (moved < 1e-16 || (moved < 1e-12 && moved > 0.25 * before)) break;
    before = moved;
  }
  return v;
}

}  // namespace

BezierSpan::BezierSpan(const Scene& scene, std::size_t first, std::size_t end) : first_(first) {
  const auto place = [&](const Element& element, Point2 point, bool at_start) {
    const BezierPiece& on = *scene.bezier_piece(element);
    return NearestOnBezier(scene.beziers()[on.bezier], point, on.from, on.to, at_start ? on.from : on.to);
  };
  from_ = place(scene.elements()[first], scene.elements()[first].a, true);
  to_ = place(scene.elements()[end - 1], scene.elements()[end - 1].b, false);
  for (std::size_t i = first; i < end; ++i)
    ends_.push_back((place(scene.elements()[i], scene.elements()[i].b, false) - from_) / (to_ - from_));
  part_ = PartOf(scene.beziers()[scene.bezier_piece(scene.elements()[first])->bezier], from_, to_);
}

std::optional<double> BezierSpan::Meet(Point2 from, Vector2 direction, bool front) const {
  Cubic f;
  for (int i = 0; i < 4; ++i) f.c[i] = Cross(direction, part_.p[i] - from);
  double borders[4] = {-kBeyond};
  int count = 1;
  const Roots stands = StandsOf(f);
  for (int i = 0; i < stands.count; ++i)
    if (stands.at[i] > borders[0] && stands.at[i] < 1 + kBeyond) borders[count++] = stands.at[i];
  borders[count] = 1 + kBeyond;
  double low = borders[0], at_low = f.At(low);
  for (int i = 1; i <= count; ++i) {
    const double high = borders[i], at_high = f.At(high);
    // Across the direction the curve rises where its front is met.
    if (front ? at_low <= 0 && at_high > 0 : at_low >= 0 && at_high < 0)
      return RootBetween(f, low, high, at_low, at_high);
    low = high, at_low = at_high;
  }
  return std::nullopt;
}

std::optional<double> BezierSpan::TouchedAlong(Vector2 direction) const {
  Cubic f;
  for (int i = 0; i < 4; ++i) f.c[i] = Cross(direction, part_.p[i] - part_.p[0]);
  const Roots stands = StandsOf(f);
  for (int i = 0; i < stands.count; ++i)
    if (stands.at[i] > -kBeyond && stands.at[i] < 1 + kBeyond) return std::clamp(stands.at[i], 0.0, 1.0);
  return std::nullopt;
}

SurfacePoint BezierSpan::OnElement(const Scene& scene, double v) const {
  const auto i = std::min<std::size_t>(
      static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), v) - ends_.begin()), ends_.size() - 1);
  const Element& element = scene.elements()[first_ + i];
  Receiver beside;
  PlaceOnBezier(element, scene.beziers()[scene.bezier_piece(element)->bezier], from_ + v * (to_ - from_), 1, beside);
  return {beside.position, static_cast<ElementId>(first_ + i)};
}

bool BezierSpan::IsPassedBy(const LineFamily& lines, double margin) const {
  double low = lines.LeftOf(part_.p[0]).Min();
  const bool left = low > margin;
  for (const Point2& point : part_.p) {
    const Bernstein offset = lines.LeftOf(point);
    if (left ? !(offset.Min() > margin) : !(offset.Max() < -margin)) return false;
  }
  return true;
}

void BezierSpan::AddEvents(const LineFamily& lines, std::vector<double>& events) const {
  for (const Point2& end : {part_.p[0], part_.p[3]}) {
    const Bernstein::RootList roots = lines.LeftOf(end).Roots();
    events.insert(events.end(), roots.t.begin(), roots.t.begin() + static_cast<std::ptrdiff_t>(roots.count));
  }
  // The touching point is on the span between lines along the tangents at its ends.
  std::vector<double> borders{0, 1};
  for (const double v : {0.0, 1.0}) {
    const Vector2 tangent = part_.Tangent(v, v == 0 ? 1 : -1);
    Bernstein across;
    for (std::size_t k = 0; k < Bernstein::kCount; ++k)
      across.b[k] = lines.x.b[k] * tangent.y - lines.y.b[k] * tangent.x;
    const Bernstein::RootList roots = across.Roots();
    borders.insert(borders.end(), roots.t.begin(), roots.t.begin() + static_cast<std::ptrdiff_t>(roots.count));
  }
  std::sort(borders.begin(), borders.end());
  for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
    const double middle = 0.5 * (borders[i] + borders[i + 1]);
    if (TouchedAlong({lines.x.At(middle), lines.y.At(middle)})) AddTouches(lines, borders[i], borders[i + 1], events);
  }
}

// How far the touching point of a direction lies to the left of its line.
double BezierSpan::TouchOffset(const LineFamily& lines, double t) const {
  const Vector2 direction{lines.x.At(t), lines.y.At(t)};
  const std::optional<double> v = TouchedAlong(direction);
  // At the borders rounding may lose it.
  const auto slant = [&](double end, int side) { return std::abs(Cross(direction, part_.Tangent(end, side))); };
  const Point2 point = v ? At(*v) : slant(0, 1) < slant(1, -1) ? part_.p[0] : part_.p[3];
  return Cross(direction, point - Point2{}) - lines.moment.At(t);
}

void BezierSpan::AddTouches(const LineFamily& lines, double low, double high, std::vector<double>& events) const {
  std::array<double, Bernstein::kCount> values{};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = TouchOffset(lines, low + Bernstein::Nodes()[i] * (high - low));
  const Bernstein offset = Bernstein::Through(values);
  double off = 0;
  for (const double t : {0.0301536896, 0.32898992833716567, 0.58682408883346, 0.97})
    off = std::max(off, std::abs(offset.At(t) - TouchOffset(lines, low + t * (high - low))));
  if (offset.Min() > 4 * off || offset.Max() < -4 * off) return;
  if (off > kOffset && high - low > kLeastPart) {
    const double middle = 0.5 * (low + high);
    AddTouches(lines, low, middle, events);
    AddTouches(lines, middle, high, events);
    return;
  }
  const Bernstein::RootList roots = offset.Roots();
  for (std::size_t i = 0; i < roots.count; ++i) {
    double from = low + std::max(roots.t[i] - kRootWithin, 0.0) * (high - low);
    double to = low + std::min(roots.t[i] + kRootWithin, 1.0) * (high - low);
    const bool at_from = TouchOffset(lines, from) > 0;
    if (at_from == (TouchOffset(lines, to) > 0)) {
      events.push_back(low + roots.t[i] * (high - low));
      continue;
    }
    for (double middle; from < (middle = 0.5 * (from + to)) && middle < to && to - from > 1e-15;)
      ((TouchOffset(lines, middle) > 0) == at_from ? from : to) = middle;
    events.push_back(0.5 * (from + to));
  }
}

BezierSpans::BezierSpans(const Scene& scene) : span_of_(scene.elements().size(), kNone) {
  const std::vector<Element>& elements = scene.elements();
  const auto bends = [&](const Element& element) {
    const BezierPiece* const on = scene.bezier_piece(element);
    return on != nullptr && on->bends;
  };
  for (std::size_t i = 0; i < elements.size();) {
    std::size_t end = i + 1;
    if (bends(elements[i])) {
      const auto goes_on = [&](const Element& e, const Element& f) {
        return bends(f) && f.bezier_piece == e.bezier_piece + 1 && e.b == f.a &&
               scene.bezier_piece(e)->run == scene.bezier_piece(f)->run;
      };
      while (end < elements.size() && goes_on(elements[end - 1], elements[end])) ++end;
      for (std::size_t k = i; k < end; ++k) span_of_[k] = static_cast<std::uint32_t>(spans_.size());
      spans_.emplace_back(scene, i, end);
    }
    i = end;
  }
}

}  // namespace flatlight
