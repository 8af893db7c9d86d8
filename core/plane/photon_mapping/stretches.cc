// SPDX-License-Identifier: Apache-2.0
#include "core/plane/photon_mapping/stretches.h"

#include <algorithm>

#include "core/math/trig.h"
#include "core/plane/walls.h"
#include "core/scene/element_frame.h"

namespace flatlight {
namespace {

double ArcLengthOn(const Element& element, Point2 p) { return FractionAt(element, p) * element.length; }

}  // namespace

Stretches::Stretches(const Scene& scene) : scene_(scene) {
  const std::vector<Element>& elements = scene.elements();
  const Walls walls(scene);
  const double near = 4 * scene.touch_distance();
  const auto walled_begin = [&](std::size_t e) { return !walls.On(e).empty() && walls.On(e).front().at <= near; };
  const auto walled_end = [&](std::size_t e) {
    return !walls.On(e).empty() && walls.On(e).back().at >= elements[e].length - near;
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
      for (const Wall& wall : walls.On(e)) {
        if (wall.at <= begin + near || wall.at >= elements[e].length - near) continue;
        add(wall.at);
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
