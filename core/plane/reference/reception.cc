// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/reception.h"

#include <algorithm>
#include <cmath>

#include "core/math/tolerances.h"
#include "core/plane/reference/brightest_light.h"
#include "core/plane/reference/kernel.h"
#include "core/plane/reference/row.h"
#include "core/plane/reference/specular_derivatives.h"
#include "core/plane/reference/unfollowed_motion.h"

namespace flatlight {
namespace {

// Of a term of a sum over Gauss points: a few operations, and its share of the sum's.
constexpr double kRounding = 8 * kUnitRoundoff;
// A largest weight so many times the mean one may be larger yet. (On a point its moments say kLightCoefficients^2.)
constexpr double kUneven = 24;
// Slopes and second derivatives, by a panel's place in [-1, 1], of an error of light of size 1: as with kErrorSlope,
// and of what was missed between the points of a panel.
constexpr double kErrorBend = 24;
constexpr double kMissedSlope = 8, kMissedBend = 64;

// Where ends move in a way that cannot be told, irradiance is known all the same.
void TakeStill(const SpecularGather::Moments& still, SpecularDerivatives::Moments& moments) {
  moments.value[0] = still.value;
  moments.error[0] = still.error;
  moments.of_value[0] = std::abs(still.value[0]);
}

}  // namespace

// By Hölder's inequality: the largest weight times the mean, both roots of mean squares, or the mean weight times the
// largest. Weights are known by their first moments alone: where these say that weights lie on a small part of the
// panel it may be a far smaller one, and what is off most may lie there.
double LightErrors::Missed(std::size_t index, const double* weights) const {
  double factor = missed[index];
  if (most[index] > 0 && weights[0] > 0) {
    double largest = 1, square = 1;
    for (std::size_t k = 1; k < kLightCoefficients; ++k) {
      const double share = std::abs(weights[k]) / weights[0], count = static_cast<double>(2 * k + 1);
      largest += count * share;
      square += count * share * share;
    }
    const double off = largest > kUneven ? most[index]
                                         : std::min({most[index], std::sqrt(square) * root_mean_square[index],
                                                     in_all[index] + (largest - 1) * mean[index]});
    factor = std::max(factor, off);
  }
  return factor * weights[0];
}

void LightErrors::GuessSlopes(const Chart& chart, const Panel& panel, std::size_t i, std::size_t channels) {
  const double speed = std::min(chart.At(panel.low).speed, chart.At(panel.high).speed);
  const double by_length = kErrorSlope * 2 / ((panel.high - panel.low) * speed);
  for (std::size_t at = i * channels; at < (i + 1) * channels; ++at) slope[at] = by_length * value[at];
}

Received Reception::At(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light,
                       const LightErrors* errors, int derivatives, std::optional<SpecularSight>* sight) {
  Received sum;
  shares_.clear();
  for (auto& of_derivative : of_residuals_)
    for (ErrorSum& of_residuals : of_derivative) of_residuals = {};
  end_errors_ = EndErrors(scene_);
  for (const VisiblePiece& piece : outlook_.From(receiver))
    AddPiece(receiver, mesh, light, errors, derivatives, piece, sum);
  if (specular_) {
    std::optional<SpecularSight> own;
    if (sight == nullptr) sight = &own;
    if (!sight->has_value()) {
      *sight = SpecularSight{specular_->view().From(receiver), specular_->view().lost(), {}};
      if (derivatives > 0) (*sight)->unfollowed = specular_->view().unfollowed();
    }
    if (derivatives == 0)
      AddSpecular(receiver, mesh, light, errors, **sight, sum);
    else
      AddMovingSpecular(receiver, mesh, light, errors, derivatives, **sight, sum);
  }
  for (std::size_t c = 0; c < light.channels(); ++c) {
    sum.error[0].value[c] += of_residuals_[0][c].rest();
    for (int m = 1; m <= derivatives; ++m) sum.error[m].value[c] += of_residuals_[m][c].total();
    sum.rounding[0].value[c] += end_errors_.joints();
  }
  return sum;
}

void Reception::AddPiece(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light,
                         const LightErrors* errors, int derivatives, const VisiblePiece& piece, Received& sum) {
  const PanelMesh::Range range = mesh.On(piece.element, piece.side);
  if (range.first == range.last) return;
  if (derivatives == 0 && end_errors_.IsDoubtful(receiver, piece)) return;
  const Chart& chart = charts_[static_cast<std::size_t>(piece.element)];
  const double radius = OwnRadius(scene_, receiver, piece.element);
  const double low = std::min(piece.begin.u, piece.end.u), high = std::max(piece.begin.u, piece.end.u);
  const std::size_t channels = light.channels();
  double p[kResidualCoefficients];
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Panel& panel = mesh.panels()[i];
    const double from = std::max(low, panel.low), to = std::min(high, panel.high);
    if (!(from < to)) continue;
    double absolute[3] = {0, 0, 0}, weights_of_light[kLightCoefficients] = {};
    Spectrum off[3];
    const auto add_weights = [&](double u, const double(&weight)[3]) {
      Legendre(panel.Local(u), errors ? kResidualCoefficients : kLightCoefficients, p);
      for (int m = 0; m <= derivatives; ++m) absolute[m] += std::abs(weight[m]);
      if (errors)
        for (std::size_t k = 0; k < kLightCoefficients; ++k) weights_of_light[k] += weight[0] * p[k];
      for (std::size_t c = 0; c < channels; ++c) {
        const double radiance = light.At(i, c, p);
        const double residual = errors ? errors->residual.At(i, c, p) : 0;
        sum.value[0].value[c] += weight[0] * residual;
        for (int m = 0; m <= derivatives; ++m) {
          sum.value[m].value[c] += weight[m] * radiance;
          sum.rounding[m].value[c] += kRounding * std::abs(weight[m] * radiance);
          off[m].value[c] += weight[m] * residual;
        }
      }
    };
    const auto add = [&](double u, const Chart::Place& place, double weight) {
      const Kernel kernel(receiver, place, piece.side, radius);
      double weights[3] = {weight * kernel.Value(), 0, 0};
      if (derivatives > 0) {
        const Kernel::Derivatives d = kernel.Derive();
        weights[1] = weight * d.first, weights[2] = weight * d.second;
      }
      add_weights(u, weights);
    };
    // Where the piece ends at the receiver itself, in a corner, all that is seen of it may be there: its end tells.
    const auto sine_at = [&](double u) {
      if (u == piece.begin.u) return piece.begin.edge.s;
      return u == piece.end.u ? piece.end.edge.s : SineTo(chart, receiver, u);
    };
    const auto rest = [&](double u, double begin, double end) {
      add_weights(u, {std::abs(sine_at(end) - sine_at(begin)), 0, 0});
    };
    ForEachPoint(chart, receiver.position, radius != 0, errors ? high_count_ : count_, from, to, 0, add, rest);
    if (!errors) continue;
    double share = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const double missed = errors->Missed(i * channels + c, weights_of_light), other = errors->value[i * channels + c];
      const double own = std::max(errors->missed[i * channels + c], errors->root_mean_square[i * channels + c]);
      for (int m = 0; m <= derivatives; ++m) {
        // Derivatives see more of what is not smooth.
        of_residuals_[m][c].Add((m == 0 ? 1 : 2) * off[m].value[c], m == 0 ? missed : 6 * absolute[m] * own);
        sum.error[m].value[c] += absolute[m] * other;
      }
      sum.indirect.value[c] += absolute[0] * other;
      share = std::max(share, ErrorSum::RestOf(off[0].value[c], missed));
    }
    shares_.push_back({i, share, absolute[0]});
  }
  AddEnd(receiver, mesh, light, errors, derivatives, piece, false, sum);
  AddEnd(receiver, mesh, light, errors, derivatives, piece, true, sum);
}

void Reception::AddSpecular(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light,
                            const LightErrors* errors, const SpecularSight& sight, Received& sum) {
  const std::size_t channels = light.channels();
  double uncertain = sight.lost;
  for (const SpecularPiece& piece : sight.pieces) {
    const Spectrum& tint = piece.way->tint;
    const Spectrum emitted = EmittedBy(scene_, piece);
    if (!emitted.IsBlack()) {
      const SpecularGather::Moments moments = specular_->OfPiece(receiver, piece);
      sum.value[0] = sum.value[0] + moments.value[0] * (tint * emitted);
      uncertain += moments.error;
    }
    const std::size_t count = errors ? kResidualCoefficients : kLightCoefficients;
    specular_->OfPanels(receiver, piece, mesh, count, [&](std::size_t i, const auto& moments_of) {
      const SpecularGather::Moments moments = moments_of();
      uncertain += moments.error;
      double share = 0, most_tint = 0;
      for (std::size_t c = 0; c < channels; ++c) {
        most_tint = std::max(most_tint, tint.value[c]);
        sum.value[0].value[c] += tint.value[c] * light.At(i, c, moments.value.data());
        if (!errors) continue;
        const double off = tint.value[c] * errors->residual.At(i, c, moments.value.data());
        const double missed = tint.value[c] * errors->Missed(i * channels + c, moments.value.data());
        sum.value[0].value[c] += off;
        of_residuals_[0][c].Add(off, missed);
        const double other = tint.value[c] * moments.value[0] * errors->value[i * channels + c];
        sum.error[0].value[c] += other;
        sum.indirect.value[c] += other;
        share = std::max(share, ErrorSum::RestOf(off, missed));
      }
      if (errors) shares_.push_back({i, share, most_tint * moments.value[0]});
    });
  }
  if (!errors) return;
  for (std::size_t c = 0; c < channels; ++c) {
    sum.unfollowed.value[c] = uncertain * errors->brightest.value[c];
    sum.rounding[0].value[c] += sum.unfollowed.value[c] + kRounding * std::abs(sum.value[0].value[c]);
  }
}

void Reception::AddMovingSpecular(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light,
                                  const LightErrors* errors, int derivatives, const SpecularSight& sight,
                                  Received& sum) {
  const std::size_t channels = light.channels();
  SpecularDerivatives moving(scene_, charts_, receiver, specular_->tolerance(), derivatives);
  UnfollowedMotion unfollowed(sight.lost, derivatives);
  for (const UnfollowedBeam& beam : sight.unfollowed) unfollowed.AddUnfollowed(moving.OfUnfollowed(beam));
  for (const SpecularPiece& piece : sight.pieces) {
    const Spectrum& tint = piece.way->tint;
    const Spectrum emitted = EmittedBy(scene_, piece);
    if (!emitted.IsBlack()) {
      SpecularDerivatives::Moments moments = moving.OfPiece(piece);
      if (!moments.known) TakeStill(specular_->OfPiece(receiver, piece), moments);
      unfollowed.Add(moments);
      for (int m = 0; m <= derivatives; ++m) {
        const auto order = static_cast<std::size_t>(m);
        sum.value[m] = sum.value[m] + moments.value[order][0] * (tint * emitted);
        sum.rounding[m] = sum.rounding[m] + kRounding * moments.of_value[order] * (tint * emitted);
      }
    }
    const std::size_t count = errors ? kResidualCoefficients : kLightCoefficients;
    specular_->VisitPanels(receiver, piece, mesh, [&](std::size_t i, const Cuts::Cut& begin, const Cuts::Cut& end) {
      SpecularDerivatives::Moments moments = moving.OfPanel(piece, mesh.panels()[i], count, begin, end);
      if (!moments.known)
        TakeStill(specular_->OfPanel(receiver, piece, mesh.panels()[i], count, begin.at, end.at), moments);
      unfollowed.Add(moments);
      double share = 0, most_tint = 0;
      for (std::size_t c = 0; c < channels; ++c) {
        const double by = tint.value[c];
        most_tint = std::max(most_tint, by);
        for (int m = 0; m <= derivatives; ++m) {
          const auto order = static_cast<std::size_t>(m);
          const double part = by * light.At(i, c, moments.value[order].data());
          sum.value[m].value[c] += part;
          sum.rounding[m].value[c] += kRounding * std::abs(part);
          if (!errors) continue;
          const double off = by * errors->residual.At(i, c, moments.value[order].data());
          const std::size_t at = i * channels + c;
          const double own = std::max(errors->missed[at], errors->root_mean_square[at]);
          const double missed = by * (m == 0 ? errors->Missed(at, moments.value[0].data())
                                             : 6 * own * moments.OfLight(order, kMissedSlope, kMissedBend));
          of_residuals_[m][c].Add((m == 0 ? 1 : 2) * off, missed);
          const double other = by * errors->value[at] * moments.OfLight(order, kErrorSlope, kErrorBend);
          sum.error[m].value[c] += other;
          if (m > 0) continue;
          sum.value[0].value[c] += off;
          sum.indirect.value[c] += other;
          share = std::max(share, ErrorSum::RestOf(off, missed));
        }
      }
      if (errors) shares_.push_back({i, share, most_tint * moments.value[0][0]});
    });
  }
  if (!errors) return;
  for (int m = 0; m <= derivatives; ++m) {
    const Spectrum uncertain = unfollowed.Of(m) * errors->brightest;
    if (m == 0) sum.unfollowed = uncertain;
    for (std::size_t c = 0; c < channels; ++c) {
      double& rounding = sum.rounding[m].value[c];
      rounding = std::min(rounding + uncertain.value[c], kUnbounded);
    }
  }
}

// A moving end: d/dx of the integral up to it.
void Reception::AddEnd(const Receiver& receiver, const PanelMesh& mesh, const PanelLight& light,
                       const LightErrors* errors, int derivatives, const VisiblePiece& piece, bool is_end,
                       Received& sum) {
  const PieceEnd& end = is_end ? piece.end : piece.begin;
  const double sign = is_end ? 1 : -1;
  const Chart& chart = charts_[static_cast<std::size_t>(piece.element)];
  const std::size_t channels = light.channels();
  const PanelMesh::Range range = mesh.On(piece.element, piece.side);
  // Of two panels that meet there, the one that is seen.
  const double inner = is_end ? piece.begin.u : piece.end.u;
  std::size_t i = range.first;
  while (i + 1 < range.last && (inner > end.u ? mesh.panels()[i].high <= end.u : mesh.panels()[i].high < end.u)) ++i;
  const Panel& panel = mesh.panels()[i];
  double p[kLightCoefficients], slopes[kLightCoefficients];
  LegendreWithSlopes(panel.Local(end.u), kLightCoefficients, p, slopes);

  double brightest = 0;
  for (std::size_t c = 0; c < channels; ++c) brightest = std::max(brightest, std::abs(light.At(i, c, p)));
  const EdgeErrors rounding = end_errors_.Add(receiver, piece.element, end, brightest);
  const double roundings[3] = {rounding.s, rounding.s_first, rounding.s_second};
  double first = 0, second = 0, slope_factor = 0, speed = 1;
  if (derivatives > 0 && !(end.own && end.edge.kind == Edge::Kind::kVertex)) {
    const EdgeDerivatives moving = Derive(end.edge, receiver.curvature);
    const Chart::Place place = chart.At(end.u);
    speed = place.speed;
    const double radius = OwnRadius(scene_, receiver, piece.element);
    Edge foot = end.edge;
    if (end.edge.kind == Edge::Kind::kHorizon && radius != 0) {
      // The receiver's own circle runs on to the horizon, where the foot is the receiver itself.
      second = 0.25 * end.edge.s * receiver.curvature * receiver.curvature;
    } else {
      if (end.own) {
        foot.signed_radius = 0;
      } else {
        foot = VertexEdge(receiver, place.position);
      }
      const EdgeDerivatives fixed = Derive(foot, receiver.curvature);
      if (!end.own) first = moving.s_first - fixed.s_first;
      second = moving.s_second - fixed.s_second;
    }
    if (!end.own && first != 0) {
      const double kernel = Kernel(receiver, place, piece.side, radius).Value();
      if (kernel > 0) slope_factor = first * first / kernel * (inner > end.u ? -1 : 1) * (is_end ? 1 : -1);
    }
  }
  const double stretch = 2 / (panel.high - panel.low) / speed;
  for (std::size_t c = 0; c < channels; ++c) {
    const double radiance = light.At(i, c, p);
    for (int m = 0; m <= derivatives; ++m) sum.rounding[m].value[c] += std::abs(radiance) * roundings[m];
    if (derivatives < 1) continue;
    sum.value[1].value[c] += sign * radiance * first;
    sum.rounding[1].value[c] += kRounding * std::abs(radiance * first);
    if (derivatives < 2) continue;
    const double radiance_slope = light.At(i, c, slopes) * stretch;
    // Along theta.
    sum.value[2].value[c] += sign * (radiance * second + slope_factor * radiance_slope);
    sum.rounding[2].value[c] += kRounding * (std::abs(radiance * second) + std::abs(slope_factor * radiance_slope));
  }
  if (!errors || derivatives < 1) return;
  for (std::size_t c = 0; c < channels; ++c) {
    const std::size_t at = i * channels + c;
    const double error = 2 * errors->size[at] + errors->value[at];
    sum.error[1].value[c] += error * std::abs(first);
    if (derivatives < 2) continue;
    const double slope = 2 * errors->steep[at] * stretch + errors->slope[at];
    sum.error[2].value[c] += error * std::abs(second) + slope * std::abs(slope_factor);
  }
}

}  // namespace flatlight
