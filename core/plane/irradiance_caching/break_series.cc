// SPDX-License-Identifier: Apache-2.0
#include "core/plane/irradiance_caching/break_series.h"

#include <array>
#include <cstddef>

namespace flatlight {

DirectionSeries SeriesOf(const Edge& edge, const Receiver& receiver) {
  ArcSeries s, c, q, turn, cq, qq, sqq, cqqq;
  s[0] = edge.s;
  if (edge.kind == Edge::Kind::kHorizon) return {s, c};
  const std::array<double, 3> bend = {receiver.curvature, receiver.curvature_change, 0.5 * receiver.curvature_second};
  c[0] = edge.c, q[0] = edge.q;
  for (std::size_t k = 0; k + 1 < kRecordOrders; ++k) {
    cq[k] = ArcSeries::Times(c, q, k);
    qq[k] = ArcSeries::Times(q, q, k);
    sqq[k] = ArcSeries::Times(s, qq, k);
    cqqq[k] = ArcSeries::Times(cq, qq, k);
    turn[k] = (k < bend.size() ? bend[k] : 0) - cq[k];
    const double step = 1 / static_cast<double>(k + 1);
    s[k + 1] = step * ArcSeries::Times(c, turn, k);
    c[k + 1] = -step * ArcSeries::Times(s, turn, k);
    q[k + 1] = step * (sqq[k] + edge.signed_radius * cqqq[k]);
  }
  return {s, c};
}

}  // namespace flatlight
