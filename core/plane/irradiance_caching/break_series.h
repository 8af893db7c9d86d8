// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_BREAK_SERIES_H_
#define FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_BREAK_SERIES_H_

#include "core/cache/record.h"
#include "core/math/series.h"
#include "core/plane/exact/edge.h"

namespace flatlight {

// Of arc length along the receiver.
using ArcSeries = Series<kRecordOrders>;

// A direction in which what is seen begins or ends, as the receiver moves along a line or circle, or, up to the third
// derivative, along another curve: the break law theta' = kappa - c q, q' = s q^2 + R c q^3 to any order (see Derive in
// edge.h; THEORY 18 B1).
struct DirectionSeries {
  ArcSeries sine, cosine;
};
DirectionSeries SeriesOf(const Edge& edge, const Receiver& receiver);
inline ArcSeries SineSeries(const Edge& edge, const Receiver& receiver) { return SeriesOf(edge, receiver).sine; }

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_BREAK_SERIES_H_
