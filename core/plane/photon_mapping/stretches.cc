// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/stretches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/trig.h"
#include "core/plane/box.h"
#include "core/plane/intersect.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

// Directions that differ by less are one.
constexpr double kSameDirection = 1e-9;

double ArcLengthOn(const Element& element, Point2 p) { return FractionAt(element, p) * element.length; }

// Whether one goes on smoothly where the other ends.
bool GoesOn(const Element& before, const Element& after) {
  if (before.curve != after.curve || !(before.b == after.a)) return false;
  const Vector2 end = FrameAt(before, 1).tangent, begin = FrameAt(after, 0).tangent;
  return Dot(end, begin) > 0 && std::abs(Cross(end, begin)) <= kSameDirection;
}

// Where on each element other curves touch or cross it, by arc length along it.
class Walls {
 public:
  explicit Walls(const Scene& scene) : scene_(scene), near_(2 * scene.touch_distance()), at_(scene.elements().size()) {
    const std::vector<Element>& elements = scene.elements();
    std::vector<Box> boxes;
    double width = 0, height = 0;
    for (const Element& element : elements) {
      boxes.push_back(BoxOf(element, near_));
      width += boxes.back().high.x - boxes.back().low.x;
      height += boxes.back().high.y - boxes.back().low.y;
    }
    // Swept along the axis along which elements are short.
    if (width < height) {
      Sweep(
          boxes, [](Point2 p) { return p.x; }, [](Point2 p) { return p.y; });
    } else {
      Sweep(
          boxes, [](Point2 p) { return p.y; }, [](Point2 p) { return p.x; });
    }
    for (std::vector<double>& walls : at_) std::sort(walls.begin(), walls.end());
  }

  const std::vector<double>& At(std::size_t element) const { return at_[element]; }

 private:
  template <typename Along, typename Across>
  void Sweep(const std::vector<Box>& boxes, Along along, Across across) {
    std::vector<std::uint32_t> order(boxes.size()), open;
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      const double a = along(boxes[i].low), b = along(boxes[j].low);
      return a < b || (a == b && i < j);
    });
    for (const std::uint32_t i : order) {
      const Box& box = boxes[i];
      std::size_t kept = 0;
      for (const std::uint32_t j : open) {
        if (along(boxes[j].high) < along(box.low)) continue;
        open[kept++] = j;
        if (across(boxes[j].low) <= across(box.high) && across(box.low) <= across(boxes[j].high)) Meet(i, j);
      }
      open.resize(kept);
      open.push_back(i);
    }
  }

  void Meet(std::uint32_t i, std::uint32_t j) {
    const Element &e = scene_.elements()[i], &f = scene_.elements()[j];
    if (e.carrier == f.carrier || GoesOn(e, f) || GoesOn(f, e)) return;
    const auto add = [&](Point2 p) {
      at_[i].push_back(ArcLengthOn(e, p));
      at_[j].push_back(ArcLengthOn(f, p));
    };
    for (const Point2 p : {f.a, f.b})
      if (DistanceTo(e, p) <= near_) add(p);
    for (const Point2 p : {e.a, e.b})
      if (DistanceTo(f, p) <= near_) add(p);
    const ElementCrossings crossings = CrossElements(e, f, scene_.touch_distance());
    for (int c = 0; c < crossings.count; ++c) add(crossings.point[c]);
  }

  const Scene& scene_;
  double near_;
  std::vector<std::vector<double>> at_;
};

}  // namespace

Stretches::Stretches(const Scene& scene) : scene_(scene) {
  const std::vector<Element>& elements = scene.elements();
  const Walls walls(scene);
  const double near = 4 * scene.touch_distance();
  const auto walled_begin = [&](std::size_t e) { return !walls.At(e).empty() && walls.At(e).front() <= near; };
  const auto walled_end = [&](std::size_t e) {
    return !walls.At(e).empty() && walls.At(e).back() >= elements[e].length - near;
  };
  // Whether light goes over from one element to another.
  const auto joined = [&](std::size_t before, std::size_t after) {
    return GoesOn(elements[before], elements[after]) && !walled_end(before) && !walled_begin(after);
  };
  const auto begin_stretch = [&] {
    lengths_.push_back(0);
    closed_.push_back(0);
  };
  for (const Curve& curve : scene.curves()) {
    const std::size_t first = curve.first_element, last = first + curve.element_count;
    const std::size_t first_stretch = lengths_.size(), first_piece = pieces_.size();
    for (std::size_t e = first; e < last; ++e) {
      first_piece_.push_back(static_cast<std::uint32_t>(pieces_.size()));
      if (e == first || !joined(e - 1, e)) begin_stretch();
      double begin = 0;
      const auto add = [&](double end) {
        pieces_.push_back({begin, lengths_.back() - begin, static_cast<std::uint32_t>(lengths_.size() - 1)});
        lengths_.back() += end - begin;
        begin = end;
      };
      for (const double wall : walls.At(e)) {
        if (wall <= begin + near || wall >= elements[e].length - near) continue;
        add(wall);
        begin_stretch();
      }
      add(elements[e].length);
    }
    if (curve.element_count == 0 || !joined(last - 1, first)) continue;
    const auto last_stretch = static_cast<std::uint32_t>(lengths_.size() - 1);
    if (last_stretch == first_stretch) {
      closed_.back() = 1;
      continue;
    }
    // The first stretch is the end of the last one.
    for (std::size_t p = first_piece; p < pieces_.size() && pieces_[p].stretch == first_stretch; ++p) {
      pieces_[p].stretch = last_stretch;
      pieces_[p].offset += lengths_.back();
    }
    lengths_.back() += lengths_[first_stretch];
  }
  first_piece_.push_back(static_cast<std::uint32_t>(pieces_.size()));
}

SidePlace Stretches::Locate(ElementId element, Point2 on_element, Side side) const {
  const auto e = static_cast<std::size_t>(element);
  const double at = ArcLengthOn(scene_.element(element), on_element);
  const auto first = pieces_.begin() + first_piece_[e], last = pieces_.begin() + first_piece_[e + 1];
  const auto piece =
      std::prev(std::upper_bound(first + 1, last, at, [](double s, const Piece& p) { return s < p.begin; }));
  return {static_cast<SideId>(2 * piece->stretch + (side == Side::kFront ? 0 : 1)), piece->offset + at};
}

}  // namespace flatlight
