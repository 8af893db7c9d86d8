// SPDX-License-Identifier: Apache-2.0
#include "core/plane/exact/exact.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"

namespace flatlight {
namespace {

// sin theta_b - sin theta_a without losing the digits of a narrow piece: with the half-angle formula, and the piece's
// own extent where both ends are its own.
double SineDifference(const Edge& a, const Edge& b, const Receiver& receiver) {
  const double cosine = a.c * b.c + a.s * b.s;
  if (!(cosine > 0) || a.kind == Edge::Kind::kHorizon || b.kind == Edge::Kind::kHorizon) return b.s - a.s;
  double cross;
  if (a.kind == Edge::Kind::kVertex && b.kind == Edge::Kind::kVertex) {
    const Vector2 e = b.point - a.point;
    cross = Dot(receiver.tangent, e) * a.normal - Dot(receiver.normal, e) * a.tangent;
  } else {
    cross = b.tangent * a.normal - b.normal * a.tangent;
  }
  return cross * a.q * b.q * (a.c + b.c) / (1 + cosine);
}

}  // namespace

ExactSolver::ExactSolver(const Scene& scene, const Bvh& bvh, ExactOptions options)
    : scene_(scene), options_(options), gatherer_(scene, bvh), sweep_(scene) {
  if (options_.occlusion) return;
  for (std::size_t e = 0; e < scene.elements().size(); ++e) {
    const ElementId id = static_cast<ElementId>(e);
    if (scene.curve_of(id).Emits()) emitters_.push_back(id);
  }
}

ExactValue ExactSolver::Evaluate(const Receiver& receiver) {
  ExactValue value;
  if (scene_.traits().emitting_curves == 0) return value;
  if (options_.occlusion) {
    const std::vector<Part>& parts = gatherer_.Gather(receiver);
    AddIntervals(sweep_.Run(parts, receiver), parts, receiver, value);
  } else {
    for (const ElementId emitter : emitters_) {
      const Parts parts = PartsOf(scene_, emitter, receiver);
      for (int i = 0; i < parts.count; ++i) {
        single_.assign(1, parts.part[i]);
        AddIntervals(sweep_.Run(single_, receiver), single_, receiver, value);
      }
    }
  }
  // Rounding must not make light negative; the bound covers the difference.
  for (int channel = 0; channel < options_.channels; ++channel)
    value.irradiance[channel] = std::max(0.0, value.irradiance[channel]);
  for (int channel = options_.channels; channel < kMaxChannels; ++channel) {
    for (Spectrum* spectrum : {&value.irradiance, &value.gradient, &value.hessian, &value.irradiance_error,
                               &value.gradient_error, &value.hessian_error}) {
      (*spectrum)[channel] = (*spectrum)[0];
    }
  }
  return value;
}

void ExactSolver::AddIntervals(const std::vector<VisibleInterval>& intervals, const std::vector<Part>& parts,
                               const Receiver& receiver, ExactValue& value) const {
  const auto radiance_of = [&](const VisibleInterval& interval) {
    if (interval.part == VisibleInterval::kNothing) return Spectrum{};
    return scene_.curve_of(parts[static_cast<std::size_t>(interval.part)].element).EmittedRadiance(interval.side);
  };
  Spectrum before;
  std::size_t run = 0;  // Where the present radiance began.
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const Spectrum after = radiance_of(intervals[i]);
    if (after == before) continue;
    const Edge& edge = intervals[i].begin;
    const EdgeErrors errors = BoundErrors(edge, receiver.curvature, scene_.coordinate_error());
    const EdgeDerivatives derivatives = options_.derivatives > 0 ? Derive(edge, receiver.curvature) : EdgeDerivatives{};
    // A stretch of one radiance counts as a whole, whatever elements it is made of.
    const double extent = before.IsBlack() ? 0 : SineDifference(intervals[run].begin, edge, receiver);
    for (int channel = 0; channel < options_.channels; ++channel) {
      const double jump = before[channel] - after[channel];
      const double size = std::abs(jump);
      value.irradiance[channel] += before[channel] * extent;
      value.irradiance_error[channel] += size * errors.s + 4 * kUnitRoundoff * before[channel] * std::abs(extent);
      if (options_.derivatives >= 1) {
        value.gradient[channel] += jump * derivatives.s_first;
        value.gradient_error[channel] += size * errors.s_first;
      }
      if (options_.derivatives >= 2) {
        value.hessian[channel] += jump * derivatives.s_second;
        value.hessian_error[channel] += size * errors.s_second;
      }
    }
    before = after;
    run = i;
  }
}

}  // namespace flatlight
