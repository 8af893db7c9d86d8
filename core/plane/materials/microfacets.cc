// SPDX-License-Identifier: Apache-2.0
#include "core/plane/materials/microfacets.h"

#include <cmath>

namespace flatlight {
namespace {

double Dot(LocalDirection a, LocalDirection b) { return a.sine * b.sine + a.cosine * b.cosine; }

}  // namespace

LocalDirection Microfacets::HalfWay(LocalDirection out, LocalDirection in) {
  const double sine = out.sine + in.sine;
  const double cosine = out.cosine + in.cosine;
  const double length = std::sqrt(sine * sine + cosine * cosine);
  return {sine / length, cosine / length};
}

double Microfacets::Distribution(LocalDirection normal) const {
  const double square = alpha_ * alpha_;
  const double q = square * normal.cosine * normal.cosine + normal.sine * normal.sine;
  return square / (2 * q * std::sqrt(q));
}

double Microfacets::Lambda(LocalDirection direction) const {
  const double tangent = alpha_ * direction.sine / direction.cosine;
  return 0.5 * (std::sqrt(1 + tangent * tangent) - 1);
}

double Microfacets::Value(LocalDirection out, LocalDirection in) const {
  if (!(out.cosine > 0) || !(in.cosine > 0)) return 0;
  const LocalDirection facet = HalfWay(out, in);
  const double seen = 1 / (1 + Lambda(out) + Lambda(in));
  return Distribution(facet) * seen * Dot(in, facet) / (2 * in.cosine * out.cosine);
}

double Microfacets::Density(LocalDirection out, LocalDirection in) const {
  if (!(out.cosine > 0) || !(in.cosine > 0)) return 0;
  const LocalDirection facet = HalfWay(out, in);
  // A turn of the facet turns the reflection twice as far.
  return Distribution(facet) * Dot(out, facet) / (2 * out.cosine * (1 + Lambda(out)));
}

std::optional<LocalDirection> Microfacets::Sample(LocalDirection out, double u, double) const {
  // Stretched so that the facets' ellipse is a circle, of which the visible half projects uniformly.
  double x = alpha_ * out.sine;
  double y = out.cosine;
  const double length = std::sqrt(x * x + y * y);
  x /= length;
  y /= length;
  const double h = x >= 0 ? -1 + u * (1 + y) : 1 - u * (1 + y);
  const double along = std::sqrt((1 - h) * (1 + h));
  const double facet_x = alpha_ * (x * along + y * h);
  const double facet_y = y * along - x * h;
  const double facet_length = std::sqrt(facet_x * facet_x + facet_y * facet_y);
  if (!(facet_length > 0)) return std::nullopt;
  const LocalDirection facet{facet_x / facet_length, facet_y / facet_length};
  const double twice = 2 * Dot(out, facet);
  const LocalDirection in{twice * facet.sine - out.sine, twice * facet.cosine - out.cosine};
  if (!(in.cosine > 0)) return std::nullopt;
  return in;
}

}  // namespace flatlight
