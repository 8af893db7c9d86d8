// SPDX-License-Identifier: Apache-2.0
// Béziers as lines meet them: the curves themselves, not the arcs that follow them.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_BEZIER_SPAN_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_BEZIER_SPAN_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/bezier.h"
#include "core/plane/chains/line_family.h"
#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// A stretch of a Bézier that bends to one side, by less than half a turn: no line meets it more than twice, once from
// either side, and at most one of its points is touched by lines of one direction. Places on it are numbers in [0, 1].
class BezierSpan {
 public:
  // Of the elements from `first` up to `end`, which follow it.
  BezierSpan(const Scene& scene, std::size_t first, std::size_t end);

  std::size_t first() const { return first_; }
  std::size_t end() const { return first_ + ends_.size(); }
  Point2 At(double v) const { return part_.At(v); }
  // Unit, of the front.
  Vector2 FrontAt(double v) const { return Left(part_.Tangent(v, 1)); }
  // Where the line from a place along a unit direction comes to the front, or to the back. A little beyond the ends,
  // too: the Bézier goes on there.
  std::optional<double> Meet(Point2 from, Vector2 direction, bool front) const;
  // Where lines of a direction touch it.
  std::optional<double> TouchedAlong(Vector2 direction) const;
  // The point beside a place on the element that follows it there.
  SurfacePoint OnElement(const Scene& scene, double v) const;

  // Whether none of the lines comes nearer to it than `margin`.
  bool IsPassedBy(const LineFamily& lines, double margin) const;
  // Adds where lines of a family pass its ends or touch it, as fractions of the family.
  void AddEvents(const LineFamily& lines, std::vector<double>& events) const;

 private:
  double TouchOffset(const LineFamily& lines, double t) const;
  void AddTouches(const LineFamily& lines, double low, double high, std::vector<double>& events) const;

  Bezier part_;
  std::size_t first_;
  double from_ = 0, to_ = 1;  // Of the whole Bézier.
  std::vector<double> ends_;  // Of elements, in [0, 1].
};

// All of a scene. Immutable.
class BezierSpans {
 public:
  explicit BezierSpans(const Scene& scene);

  const std::vector<BezierSpan>& spans() const { return spans_; }
  // Null if the element stands for itself.
  const BezierSpan* Of(ElementId element) const {
    const std::uint32_t i = span_of_[static_cast<std::size_t>(element)];
    return i == kNone ? nullptr : &spans_[i];
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<BezierSpan> spans_;
  std::vector<std::uint32_t> span_of_;  // By element.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_BEZIER_SPAN_H_
