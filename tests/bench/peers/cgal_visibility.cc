// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/cgal_visibility.h"

#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangular_expansion_visibility_2.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace flatlight {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Traits = CGAL::Arr_segment_traits_2<Kernel>;
using Arrangement = CGAL::Arrangement_2<Traits>;
// Without regularisation: pieces seen edge-on are not searched for and cut off.
using Visibility = CGAL::Triangular_expansion_visibility_2<Arrangement, CGAL::Tag_false>;

std::vector<Traits::X_monotone_curve_2> ToCgal(const std::vector<SegmentDescription>& segments) {
  std::vector<Traits::X_monotone_curve_2> curves;
  const auto add = [&](Point2 a, Point2 b) {
    curves.emplace_back(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y));
  };
  for (const SegmentDescription& segment : segments) add(segment.a, segment.b);
  add({0, 0}, {1, 0}), add({1, 0}, {1, 1}), add({1, 1}, {0, 1}), add({0, 1}, {0, 0});
  return curves;
}

}  // namespace

struct CgalVisibility::Impl {
  Arrangement arrangement;
  Visibility visibility;
  Arrangement::Face_const_handle inside;
  Arrangement::Halfedge_const_handle floor;  // With the inside on its left.
  std::vector<Kernel::Point_2> queries;
  bool on_floor = false;
  Arrangement output;

  Arrangement::Face_handle Visible(std::size_t query) {
    return on_floor ? visibility.compute_visibility(queries[query], floor, output)
                    : visibility.compute_visibility(queries[query], inside, output);
  }
};

CgalVisibility::CgalVisibility(const std::vector<SegmentDescription>& segments) : impl_(std::make_unique<Impl>()) {
  const std::vector<Traits::X_monotone_curve_2> curves = ToCgal(segments);
  CGAL::insert_non_intersecting_curves(impl_->arrangement, curves.begin(), curves.end());
  // The square's outside and inside: single segments make no faces of their own.
  if (impl_->arrangement.number_of_faces() != 2) {
    std::fprintf(stderr, "peers: CGAL sees %zu faces instead of 2\n", impl_->arrangement.number_of_faces());
    std::exit(1);
  }
  for (auto face = impl_->arrangement.faces_begin(); face != impl_->arrangement.faces_end(); ++face)
    if (!face->is_unbounded()) impl_->inside = face;
  for (auto edge = impl_->arrangement.halfedges_begin(); edge != impl_->arrangement.halfedges_end(); ++edge) {
    if (edge->source()->point() == Kernel::Point_2(0, 0) && edge->target()->point() == Kernel::Point_2(1, 0))
      impl_->floor = edge;
  }
  impl_->visibility.attach(impl_->arrangement);
}

CgalVisibility::~CgalVisibility() = default;

void CgalVisibility::SetQueries(const std::vector<Point2>& points, bool on_floor) {
  impl_->queries.clear();
  for (const Point2& p : points) impl_->queries.emplace_back(p.x, p.y);
  impl_->on_floor = on_floor;
}

void CgalVisibility::Compute(std::size_t first, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) impl_->Visible(first + i);
}

std::vector<Point2> CgalVisibility::Polygon(std::size_t query) {
  std::vector<Point2> polygon;
  const Arrangement::Face_handle face = impl_->Visible(query);
  auto edge = face->outer_ccb();
  do {
    const Kernel::Point_2& p = edge->target()->point();
    polygon.push_back({p.x(), p.y()});
  } while (++edge != face->outer_ccb());
  return polygon;
}

}  // namespace flatlight
