// SPDX-License-Identifier: Apache-2.0
// Where the rays of a family begin or cease to meet things.
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_BEAM_CUTS_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_BEAM_CUTS_H_

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/plane/chains/line_family.h"
#include "core/scene/scene.h"

namespace flatlight {

// What a line passes: a point that lies so far to its left. Touches a circle where that is plus or minus its radius.
struct LineMark {
  Point2 point;
  double offset = 0;
};

// Numbers that cut a stretch of a family of lines into parts.
class Cuts {
 public:
  struct Cut {
    double at = 0;
    std::optional<LineMark> mark;  // Of what the line there passes, if that is why.
  };

  Cuts(double begin, double end) : cuts_{{begin, {}}, {end, {}}} {}

  void Add(double u) { Add({u, {}}); }
  void AddRoots(const LineFamily& lines, const Bernstein& f) { AddRoots(lines, f, {}); }
  // Where a line passes a point that lies so far to its left.
  void AddPassing(const LineFamily& lines, const LineMark& mark) {
    AddRoots(lines, lines.LeftOf(mark.point, mark.offset), mark);
  }
  // Where rays begin or cease to meet an element.
  void AddEndsOf(const Element& element, const LineFamily& lines) {
    AddPassing(lines, {element.a});
    AddPassing(lines, {element.b});
    if (element.kind == Element::Kind::kSegment) return;
    AddPassing(lines, {element.center, element.radius});
    AddPassing(lines, {element.center, -element.radius});
  }
  // Calls visit(Cut, Cut).
  template <typename Visit>
  void VisitCuts(Visit visit) {
    std::sort(cuts_.begin(), cuts_.end(), [](const Cut& a, const Cut& b) { return a.at < b.at; });
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i)
      if (cuts_[i + 1].at - cuts_[i].at > kLeastStretch) visit(cuts_[i], cuts_[i + 1]);
  }
  // Calls visit(begin, end).
  template <typename Visit>
  void VisitStretches(Visit visit) {
    VisitCuts([&](const Cut& from, const Cut& to) { visit(from.at, to.at); });
  }

 private:
  // Shorter stretches, as fractions of a piece, are nothing.
  static constexpr double kLeastStretch = 1e-13;

  void AddRoots(const LineFamily& lines, const Bernstein& f, const std::optional<LineMark>& mark) {
    const Bernstein::RootList roots = f.Roots();
    for (std::size_t i = 0; i < roots.count; ++i) Add({lines.At(roots.t[i]), mark});
  }
  void Add(const Cut& cut) {
    if (cut.at > cuts_[0].at && cut.at < cuts_[1].at) cuts_.push_back(cut);
  }

  std::vector<Cut> cuts_;
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
