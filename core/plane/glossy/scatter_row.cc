// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/scatter_row.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/plane/reference/quadrature.h"

namespace flatlight {
namespace {

constexpr int kBisections = 52;
constexpr std::size_t kCutPoints = 20;

// Lagrange's polynomials of a Gauss rule at x: barycentric weights of its nodes are (-1)^k sqrt((1 - node^2) weight).
void Interpolate(const GaussRule& rule, double x, std::vector<double>& polynomials) {
  const std::size_t n = rule.node.size();
  polynomials.assign(n, 0.0);
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double off = x - rule.node[k];
    if (off == 0) {
      std::fill(polynomials.begin(), polynomials.end(), 0.0);
      polynomials[k] = 1;
      return;
    }
    const double sign = k % 2 == 0 ? 1 : -1;
    polynomials[k] = sign * std::sqrt((1 - rule.node[k]) * (1 + rule.node[k]) * rule.weight[k]) / off;
    sum += polynomials[k];
  }
  for (double& p : polynomials) p /= sum;
}

}  // namespace

void ScatterRowBuilder::Build(const CellMesh& mesh, std::size_t panel, double x, const std::vector<double>& directions,
                              ScatterRow& row) {
  row = {};
  const Panel& place = mesh.panels().panels()[panel];
  const Receiver receiver =
      charts_[static_cast<std::size_t>(place.element)].ReceiverAt(place.element, place.At(x), place.side);
  const std::optional<GlossyLobe>& lobe = mesh.LobeOf(panel);
  incoming_.From(receiver, mesh, lobe.has_value(), lobe ? lobe->width() : std::numbers::pi);
  const std::vector<IncomingRay>& rays = incoming_.rays();
  row.rays.resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) row.rays[i] = {rays[i].cell, rays[i].x, rays[i].y};
  if (!lobe) {
    row.bands.push_back({0, 0, rays.size()});
    for (const IncomingRay& ray : rays) row.weights.push_back(0.5 * ray.in.cosine * ray.weight);
    row.source.push_back(0.5 * incoming_.Direct());
    return;
  }
  const std::vector<Incoming::Beam> beams = incoming_.Beams();
  for (const double t : directions) {
    const LocalDirection out = DirectionOf(t);
    AddLobe(*lobe, out, row);
    for (const Incoming::Beam& beam : beams)
      row.source.back() = row.source.back() + lobe->Value(out, beam.in) * beam.irradiance;
  }
}

void ScatterRowBuilder::AddLobe(const GlossyLobe& lobe, LocalDirection out, ScatterRow& row) {
  const std::vector<IncomingRay>& rays = incoming_.rays();
  weights_.assign(rays.size(), 0.0);
  for (const IncomingStretch& stretch : incoming_.stretches()) {
    const bool low = GlossyLobe::CosineOfAngle(out, stretch.at_low) > 0;
    const bool high = GlossyLobe::CosineOfAngle(out, stretch.at_high) > 0;
    if (!low && !high) continue;
    if (low != high && lobe.stops()) {
      AddCut(lobe, out, stretch);
      continue;
    }
    for (std::size_t i = stretch.first; i < stretch.first + stretch.count; ++i)
      weights_[i] = lobe.Value(out, rays[i].in) * rays[i].in.cosine * rays[i].weight;
  }
  Spectrum source;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays[i].emitted != nullptr) source = source + weights_[i] * *rays[i].emitted;
  row.source.push_back(source);
  // Behind the cut the polynomials that continue light do not vanish, and add up to nothing.
  std::size_t begin = 0, end = rays.size();
  const auto counts = [&](std::size_t i) { return weights_[i] != 0 && rays[i].cell != IncomingRay::kNoCell; };
  while (begin < end && !counts(begin)) ++begin;
  while (end > begin && !counts(end - 1)) --end;
  row.bands.push_back({row.weights.size(), begin, end - begin});
  for (std::size_t i = begin; i < end; ++i) row.weights.push_back(counts(i) ? weights_[i] : 0);
}

// Light is the polynomial through its values at the stretch's points; the lobe is integrated with it up to its end,
// where it goes as a power, not smoothly.
void ScatterRowBuilder::AddCut(const GlossyLobe& lobe, LocalDirection out, const IncomingStretch& stretch) {
  const auto cosine_at = [&](double number) {
    return GlossyLobe::CosineOfAngle(out, incoming_.RayAt(stretch, number).in);
  };
  double inside = stretch.low, outside = stretch.high;
  if (!(GlossyLobe::CosineOfAngle(out, stretch.at_low) > 0)) std::swap(inside, outside);
  const double far = inside;
  for (int step = 0; step < kBisections; ++step) {
    const double middle = 0.5 * (inside + outside);
    (cosine_at(middle) > 0 ? inside : outside) = middle;
  }
  const GaussRule& cut = Gauss(kCutPoints);
  const GaussRule& rule = Gauss(stretch.count);
  std::vector<double> polynomials;
  for (std::size_t k = 0; k < kCutPoints; ++k) {
    // The cube of a number that is 0 at the cut.
    const double s = 0.5 * (1 + cut.node[k]), number = inside + (far - inside) * s * s * s;
    const TurningRay ray = incoming_.RayAt(stretch, number);
    const double weight =
        0.5 * cut.weight[k] * 3 * s * s * std::abs(far - inside) * ray.slope * ray.in.cosine * lobe.Value(out, ray.in);
    Interpolate(rule, ((number - stretch.low) - (stretch.high - number)) / (stretch.high - stretch.low), polynomials);
    for (std::size_t i = 0; i < stretch.count; ++i) weights_[stretch.first + i] += weight * polynomials[i];
  }
}

}  // namespace flatlight
