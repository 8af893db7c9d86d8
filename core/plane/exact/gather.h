// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_EXACT_GATHER_H_
#define FLATLIGHT_CORE_PLANE_EXACT_GATHER_H_

#include <cstdint>
#include <vector>

#include "core/plane/bvh.h"
#include "core/plane/exact/part.h"
#include "core/scene/scene.h"

namespace flatlight {

// Collects what a receiver may see: walks the tree from near to far and leaves out what lies wholly behind what was
// found before. So the work follows what is visible, not what there is. A part that is partly visible is always found.
class Gatherer {
 public:
  Gatherer(const Scene& scene, const Bvh& bvh) : scene_(scene), bvh_(bvh) {}

  // The result is valid until the next call. `tests` counts boxes and elements looked at.
  const std::vector<Part>& Gather(const Receiver& receiver);
  double tests() const { return tests_; }

 private:
  // Directions [low, next interval's low) are covered by something no farther than depth.
  struct Interval {
    double low;
    double depth;
  };
  struct Entry {
    double distance;
    double low, high;
    std::uint32_t node;
    friend bool operator<(const Entry& l, const Entry& r) { return l.distance > r.distance; }  // Nearest on top.
  };

  void Push(std::uint32_t node, const Box& box, const Receiver& receiver);
  void AddElement(std::uint32_t element, const Receiver& receiver);
  bool Hidden(double low, double high, double distance) const;
  void Cover(const Part& part, const Receiver& receiver);
  std::size_t IntervalAt(double key) const;

  const Scene& scene_;
  const Bvh& bvh_;
  std::vector<Entry> heap_;
  std::vector<Interval> intervals_;
  std::vector<Interval> scratch_;
  std::vector<Part> parts_;
  double tests_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_GATHER_H_
