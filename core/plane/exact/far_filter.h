// SPDX-License-Identifier: Apache-2.0
// Tells at little cost which parts lie so far behind others that no rounding makes them matter.
#ifndef FLATLIGHT_CORE_PLANE_EXACT_FAR_FILTER_H_
#define FLATLIGHT_CORE_PLANE_EXACT_FAR_FILTER_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/plane/exact/part.h"
#include "core/scene/scene.h"

namespace flatlight {

class FarFilter {
 public:
  explicit FarFilter(const Scene& scene) : scene_(scene) {}

  void Start(const std::vector<Part>& parts, const Receiver& receiver);

  // Of some of the parts, all of which a direction (a key) meets, those that may be the nearest or agree with it to
  // `close`, relative. In the order given; valid until the next call.
  const std::vector<std::uint32_t>& NotFar(const std::vector<std::uint32_t>& among, double key, double close);
  // The same, beside a known distance instead of the nearest one.
  const std::vector<std::uint32_t>& NotFar(const std::vector<std::uint32_t>& among, double key, double close,
                                           double distance);

 private:
  // The reciprocal distance in a unit direction d is Cross(d, line): known far better than `close` asks for. Of other
  // parts it is infinite.
  struct Line {
    double tangent;
    double normal;
    double constant;  // 0, or infinite.
  };
  double Reciprocal(std::uint32_t part, const UnitDirection& direction) const {
    const Line& line = lines_[part];
    return direction.normal * line.tangent - direction.tangent * line.normal + line.constant;
  }
  Line LineOf(const Part& part, const Receiver& receiver) const;

  const Scene& scene_;
  std::vector<Line> lines_;
  std::vector<double> reciprocals_;
  std::vector<std::uint32_t> not_far_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_EXACT_FAR_FILTER_H_
