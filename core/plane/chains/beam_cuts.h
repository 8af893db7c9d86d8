// SPDX-License-Identifier: Apache-2.0
// Where the rays of a family begin or cease to meet things.
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_BEAM_CUTS_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_BEAM_CUTS_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/plane/chains/line_family.h"
#include "core/scene/scene.h"

namespace flatlight {

// Numbers that cut a stretch of a family of lines into parts.
class Cuts {
 public:
  Cuts(double begin, double end) : at_{begin, end} {}

  void Add(double u) {
    if (u > at_[0] && u < at_[1]) at_.push_back(u);
  }
  void AddRoots(const LineFamily& lines, const Bernstein& f) {
    const Bernstein::RootList roots = f.Roots();
    for (std::size_t i = 0; i < roots.count; ++i) Add(lines.At(roots.t[i]));
  }
  // Where rays begin or cease to meet an element.
  void AddEndsOf(const Element& element, const LineFamily& lines) {
    AddRoots(lines, lines.LeftOf(element.a));
    AddRoots(lines, lines.LeftOf(element.b));
    if (element.kind == Element::Kind::kSegment) return;
    AddRoots(lines, lines.LeftOf(element.center, element.radius));
    AddRoots(lines, lines.LeftOf(element.center, -element.radius));
  }
  template <typename Visit>
  void VisitStretches(Visit visit) {
    std::sort(at_.begin(), at_.end());
    for (std::size_t i = 0; i + 1 < at_.size(); ++i)
      if (at_[i + 1] - at_[i] > kLeastStretch) visit(at_[i], at_[i + 1]);
  }

 private:
  // Shorter stretches, as fractions of a piece, are nothing.
  static constexpr double kLeastStretch = 1e-13;
  std::vector<double> at_;
};

inline bool OneSign(const Bernstein& f) { return f.Min() > 0 || f.Max() < 0; }

// Whether no line of a family meets an element.
inline bool PassBy(const LineFamily& lines, const Element& element) {
  const Bernstein a = lines.LeftOf(element.a), b = lines.LeftOf(element.b);
  if (!OneSign(a) || !OneSign(b) || (a.b[0] > 0) != (b.b[0] > 0)) return false;
  if (element.kind == Element::Kind::kSegment) return true;
  const Bernstein center = lines.LeftOf(element.center);
  return center.Min() > element.radius || center.Max() < -element.radius;
}

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_BEAM_CUTS_H_
