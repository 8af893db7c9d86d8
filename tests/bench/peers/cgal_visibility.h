// SPDX-License-Identifier: Apache-2.0
// CGAL's triangular expansion: the polygon that is visible from a point. Behind a wall of its own, as CGAL's headers
// take long to compile and want flags that the project's code must not have.
#ifndef FLATLIGHT_TESTS_BENCH_PEERS_CGAL_VISIBILITY_H_
#define FLATLIGHT_TESTS_BENCH_PEERS_CGAL_VISIBILITY_H_

#include <cstddef>
#include <memory>
#include <vector>

#include "core/math/vec.h"
#include "core/scene/description.h"

namespace flatlight {

class CgalVisibility {
 public:
  // Segments that do not touch, inside the unit square, whose sides are added as walls. Builds CGAL's arrangement and
  // triangulation.
  explicit CgalVisibility(const std::vector<SegmentDescription>& segments);
  ~CgalVisibility();
  CgalVisibility(const CgalVisibility&) = delete;
  CgalVisibility& operator=(const CgalVisibility&) = delete;

  // Points inside the square and on no segment, or on its lower side: then only what is above is visible.
  void SetQueries(const std::vector<Point2>& points, bool on_floor);

  // Computes what each of some points sees. What the timing is about.
  void Compute(std::size_t first, std::size_t count);

  // The visible polygon's corners, counter-clockwise.
  std::vector<Point2> Polygon(std::size_t query);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_BENCH_PEERS_CGAL_VISIBILITY_H_
