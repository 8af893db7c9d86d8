// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/far_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/tolerances.h"

namespace flatlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A reciprocal distance counts if it is known to this, relative.
constexpr double kKnown = 1e-6;

}  // namespace

void FarFilter::Start(const std::vector<Part>& parts, const Receiver& receiver) {
  lines_.clear();
  for (const Part& part : parts) lines_.push_back(LineOf(part, receiver));
}

FarFilter::Line FarFilter::LineOf(const Part& part, const Receiver& receiver) const {
  constexpr Line kUnknown{0, 0, kInfinity};
  if (part.kind != Part::Kind::kStraight || part.touches) return kUnknown;
  const Element& element = scene_.element(part.element);
  const Vector2 a = element.a - receiver.position, b = element.b - receiver.position, along = element.b - element.a;
  const double to_a = Length(a), to_b = Length(b);
  const double area = Cross(to_a < to_b ? a : b, along);
  const double moved = 8 * scene_.coordinate_error();
  const double doubt = 16 * kUnitRoundoff * std::max(to_a, to_b) * Length(along) + moved * (to_a + to_b);
  // Nor one that is seen edge-on.
  const double turned = std::abs(area) / (to_a * to_b);
  if (!(kKnown * std::abs(area) > doubt && kKnown * turned > moved / std::min(to_a, to_b) + 16 * kUnitRoundoff))
    return kUnknown;
  return {Dot(receiver.tangent, along) / area, Dot(receiver.normal, along) / area, 0};
}

const std::vector<std::uint32_t>& FarFilter::NotFar(const std::vector<std::uint32_t>& among, double key, double close) {
  const UnitDirection direction(key);
  double nearest = 0;
  reciprocals_.resize(among.size());
  for (std::size_t i = 0; i < among.size(); ++i) {
    reciprocals_[i] = std::abs(Reciprocal(among[i], direction));
    if (reciprocals_[i] < kInfinity) nearest = std::max(nearest, reciprocals_[i]);
  }
  const double least = nearest > 0 ? 1 / ((1 + 3 * close) / nearest + 80 * scene_.coordinate_error()) : 0;
  not_far_.clear();
  for (std::size_t i = 0; i < among.size(); ++i)
    if (reciprocals_[i] >= least) not_far_.push_back(among[i]);
  return not_far_;
}

const std::vector<std::uint32_t>& FarFilter::NotFar(const std::vector<std::uint32_t>& among, double key, double close,
                                                    double distance) {
  const UnitDirection direction(key);
  const double least = 1 / ((1 + 3 * close) * distance + 80 * scene_.coordinate_error());
  not_far_.clear();
  for (const std::uint32_t p : among)
    if (std::abs(Reciprocal(p, direction)) >= least) not_far_.push_back(p);
  return not_far_;
}

}  // namespace flatlight
