// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/radiosity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/check.h"
#include "core/math/tolerances.h"
#include "core/plane/reference/krylov.h"
#include "core/plane/reference/quadrature.h"

namespace flatlight {
namespace {

constexpr std::size_t kNodes = kLightCoefficients;
constexpr double kTolerance = 1e-15;
// Of the bound, of which two digits are plenty.
constexpr double kBoundTolerance = 1e-4;
// The largest value at nodes need not be that of the panel, nor the residual's polynomial the residual.
constexpr double kCaution = 1.5;
// At a kink coefficients fall by the square of their number; beside the last ones, so much of the mean may be missed.
constexpr double kMissed = 0.2;
// Of a row's sum, in units of roundoff.
constexpr double kRounding = 16 * kUnitRoundoff;

std::vector<double> NodesAndBetween() {
  const GaussRule& rule = Gauss(kNodes);
  const std::vector<double> between = PointsBetween(rule);
  std::vector<double> points;
  for (std::size_t i = 0; i < kNodes; ++i) points.push_back(between[i]), points.push_back(rule.node[i]);
  points.push_back(between[kNodes]);
  return points;
}

}  // namespace

Radiosity::Radiosity(const RayCaster& caster, const std::vector<Chart>& charts, PanelMesh mesh, std::size_t channels,
                     std::optional<std::uint32_t> max_bounces, Rows before)
    : scene_(caster.scene()),
      charts_(charts),
      mesh_(std::move(mesh)),
      channels_(channels),
      max_bounces_(max_bounces),
      to_coefficients_(CoefficientsFromValues(Gauss(kNodes).node)),
      to_residual_(CoefficientsFromValues(NodesAndBetween())),
      rows_{std::vector<Row>(mesh_.size() * kNodes), std::vector<Row>(mesh_.size() * (kNodes + 1))},
      rows_before_(std::move(before)),
      brightest_(channels, 0.0),
      light_(mesh_.size(), channels, kNodes),
      first_(mesh_.size(), channels, kNodes),
      before_(mesh_.size(), channels, kNodes),
      first_residual_(mesh_.size(), channels, kResidualCoefficients),
      rounding_(mesh_.size() * channels),
      spread_(mesh_.size() * kNodes * channels) {
  FLATLIGHT_DCHECK(scene_.traits().lambertian && max_bounces != 0u);
  errors_.residual = first_residual_;
  errors_.size.assign(mesh_.size() * channels, 0.0);
  errors_.steep.assign(mesh_.size() * channels, 0.0);
  errors_.missed.assign(mesh_.size() * channels, 0.0);
  errors_.value.assign(mesh_.size() * channels, 0.0);
  errors_.slope.assign(mesh_.size() * channels, 0.0);
}

std::size_t Radiosity::memory() const {
  std::size_t entries = 0, high_entries = 0;
  for (const Row& row : rows_.nodes) high_entries += row.panels.size();
  for (const Row& row : rows_.between) entries += row.panels.size();
  return (entries + high_entries) * (kNodes * sizeof(double) + sizeof(std::uint32_t)) +
         high_entries * (kResidualCoefficients - kNodes) * sizeof(float);
}

double Radiosity::HalfReflectance(std::size_t panel, std::size_t channel) const {
  return 0.5 * scene_.curve_of(mesh_.panels()[panel].element).reflectance.value[channel];
}

void Radiosity::BuildRows(RowBuilder& builder, std::size_t i) {
  const Panel& panel = mesh_.panels()[i];
  const Chart& chart = charts_[static_cast<std::size_t>(panel.element)];
  static const auto& points = *new std::vector<double>(NodesAndBetween());
  const bool known = panel.before != Panel::kNew && !rows_before_.nodes.empty();
  for (std::size_t n = 0; n < points.size(); ++n) {
    const bool node = n % 2 == 1;
    const std::size_t count = node ? kNodes : kNodes + 1;
    const Row* before =
        known ? &(node ? rows_before_.nodes : rows_before_.between)[panel.before * count + n / 2] : nullptr;
    Row& row = (node ? rows_.nodes : rows_.between)[i * count + n / 2];
    builder.Build(mesh_, chart.ReceiverAt(panel.element, panel.At(points[n]), panel.side), node, before, row);
  }
}

void Radiosity::ToCoefficients(const Values& values, Values& coefficients) const {
  coefficients.resize(values.size());
  for (std::size_t i = 0; i < values.size(); i += kNodes) {
    for (std::size_t k = 0; k < kNodes; ++k) {
      double sum = 0;
      for (std::size_t n = 0; n < kNodes; ++n) sum += to_coefficients_[k * kNodes + n] * values[i + n];
      coefficients[i + k] = sum;
    }
  }
}

void Radiosity::Transport(const Loop& loop, std::size_t channel, const Values& coefficients, Values& out) const {
  out.resize(coefficients.size());
  loop(mesh_.size(), [&](std::size_t i) {
    for (std::size_t r = i * kNodes; r < (i + 1) * kNodes; ++r) {
      const Row& row = rows_.nodes[r];
      double sum = 0;
      for (std::size_t p = 0; p < row.panels.size(); ++p)
        sum += row.TimesLight(p, &coefficients[row.panels[p] * kNodes]);
      out[r] = HalfReflectance(i, channel) * sum;
    }
  });
}

Radiosity::Values Radiosity::Accumulate(const Loop& loop, const Stop& stop, std::size_t channel, const Values& source,
                                        std::optional<std::uint32_t> bounces, Values* before) const {
  Values values(source.size(), 0.0), coefficients;
  if (!bounces) {
    const LinearMap map = [&](const Values& in, Values& out) {
      ToCoefficients(in, coefficients);
      Transport(loop, channel, coefficients, out);
      for (std::size_t r = 0; r < in.size(); ++r) out[r] = in[r] - out[r];
    };
    SolveByResiduals(map, source, before ? kTolerance : kBoundTolerance, stop, values);
    if (before) *before = values;
    return values;
  }
  Values next;
  if (*bounces > 0) values = source;
  if (before) before->assign(source.size(), 0.0);
  for (std::uint32_t bounce = 1; bounce < *bounces && !stop(); ++bounce) {
    ToCoefficients(values, coefficients);
    Transport(loop, channel, coefficients, next);
    double change = 0, most = 0;
    for (std::size_t r = 0; r < next.size(); ++r) {
      next[r] += source[r];
      change = std::max(change, std::abs(next[r] - values[r]));
      most = std::max(most, std::abs(next[r]));
    }
    if (before) *before = values;
    values.swap(next);
    // What further bounces add is of the size of their rounding, which the bound has.
    if (change <= kRounding * most) break;
  }
  return values;
}

void Radiosity::Solve(const Loop& loop, const Stop& stop) {
  rows_before_ = {};
  Values source(rows_.nodes.size()), before, coefficients;
  const auto keep = [&](const Values& values, std::size_t c, PanelLight& light) {
    ToCoefficients(values, coefficients);
    for (std::size_t i = 0; i < mesh_.size(); ++i) std::copy_n(&coefficients[i * kNodes], kNodes, light.Of(i, c));
  };
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t r = 0; r < source.size(); ++r)
      source[r] = HalfReflectance(r / kNodes, c) * rows_.nodes[r].direct.value[c];
    const Values values = Accumulate(loop, stop, c, source, max_bounces_, &before);
    brightest_[c] = scene_.environment().value[c];
    for (const double value : values) brightest_[c] = std::max(brightest_[c], value);
    for (const Curve& curve : scene_.curves()) brightest_[c] = std::max(brightest_[c], curve.radiance.value[c]);
    keep(values, c, light_);
    keep(before, c, before_);
    keep(source, c, first_);
  }
}

void Radiosity::Check(std::size_t i) {
  static const auto& points = *new std::vector<double>(NodesAndBetween());
  double p[kNodes], residual[kMaxChannels][kResidualCoefficients] = {}, first[kMaxChannels][kResidualCoefficients] = {};
  // At nodes, which have odd numbers, nothing is left over but rounding.
  for (std::size_t n = 0; n < points.size(); n += 2) {
    const Row& row = rows_.between[i * (kNodes + 1) + n / 2];
    Legendre(points[n], kNodes, p);
    for (std::size_t c = 0; c < channels_; ++c) {
      const double half = HalfReflectance(i, c), direct = row.direct.value[c];
      double sum = 0, size = direct;
      for (std::size_t e = 0; e < row.panels.size(); ++e) {
        const double* light = before_.Of(row.panels[e], c);
        sum += row.TimesLight(e, light);
        size += row.low[e * kNodes] * std::abs(light[0]);
      }
      residual[c][n] = half * (direct + sum) - light_.At(i, c, p);
      first[c][n] = half * direct - first_.At(i, c, p);
      double& rounding = rounding_[i * channels_ + c];
      rounding = std::max(rounding, half * (kRounding * size + row.coordinates * brightest_[c]));
    }
  }
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t k = 0; k < kResidualCoefficients; ++k) {
      double sum = 0, sum_first = 0;
      for (std::size_t n = 0; n < kResidualCoefficients; n += 2) {
        sum += to_residual_[k * kResidualCoefficients + n] * residual[c][n];
        sum_first += to_residual_[k * kResidualCoefficients + n] * first[c][n];
      }
      errors_.residual.Of(i, c)[k] = kCaution * sum;
      first_residual_.Of(i, c)[k] = kCaution * sum_first;
    }
    double& missed = errors_.missed[i * channels_ + c];
    for (std::size_t k = kResidualCoefficients - 3; k < kResidualCoefficients; ++k) {
      const double last = std::max(std::abs(errors_.residual.Of(i, c)[k]), std::abs(first_residual_.Of(i, c)[k]));
      missed = std::max(missed, kMissed * last);
    }
    double& size = errors_.size[i * channels_ + c];
    double& steep = errors_.steep[i * channels_ + c];
    for (const double x : points) {
      double all[kResidualCoefficients], slopes[kResidualCoefficients];
      LegendreWithSlopes(x, kResidualCoefficients, all, slopes);
      size = std::max(size, std::abs(errors_.residual.At(i, c, all)));
      steep = std::max(steep, std::abs(errors_.residual.At(i, c, slopes)));
    }
  }
}

void Radiosity::Spread(std::size_t i) {
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t r = i * kNodes; r < (i + 1) * kNodes; ++r) {
      const Row& row = rows_.nodes[r];
      double sum = 0, sum_first = 0;
      for (std::size_t p = 0; p < row.panels.size(); ++p) {
        const double missed = row.low[p * kNodes] * errors_.missed[row.panels[p] * channels_ + c];
        sum += std::abs(row.Times(p, errors_.residual.Of(row.panels[p], c))) + missed;
        if (max_bounces_) sum_first += std::abs(row.Times(p, first_residual_.Of(row.panels[p], c))) + missed;
      }
      spread_[r * channels_ + c] = HalfReflectance(i, c) * std::max(sum, sum_first);
    }
  }
}

void Radiosity::Bound(const Loop& loop, const Stop& stop) {
  Values source(rows_.nodes.size());
  for (std::size_t c = 0; c < channels_; ++c) {
    const double left_out = max_bounces_ ? kRounding * brightest_[c] : 0;
    for (std::size_t r = 0; r < rows_.nodes.size(); ++r)
      source[r] = spread_[r * channels_ + c] + rounding_[r / kNodes * channels_ + c] + left_out;
    const Values bound = Accumulate(loop, stop, c, source, max_bounces_, nullptr);
    for (std::size_t i = 0; i < mesh_.size(); ++i) {
      double most = 0;
      for (std::size_t k = 0; k < kNodes; ++k) most = std::max(most, std::abs(bound[i * kNodes + k]));
      errors_.value[i * channels_ + c] = most;
    }
  }
}

std::vector<double> Radiosity::Influence() const {
  std::vector<double> influence(mesh_.size(), 0.0);
  const GaussRule& rule = Gauss(kNodes);
  for (std::size_t r = 0; r < rows_.nodes.size(); ++r) {
    const std::size_t i = r / kNodes;
    const Panel& panel = mesh_.panels()[i];
    const double speed = charts_[static_cast<std::size_t>(panel.element)].At(panel.At(rule.node[r % kNodes])).speed;
    const double weight = 0.5 * (panel.high - panel.low) * speed * rule.weight[r % kNodes];
    const Row& row = rows_.nodes[r];
    for (std::size_t p = 0; p < row.panels.size(); ++p) {
      double most = 0;
      for (std::size_t c = 0; c < channels_; ++c) {
        const double missed = row.low[p * kNodes] * errors_.missed[row.panels[p] * channels_ + c];
        const double off = std::abs(row.Times(p, errors_.residual.Of(row.panels[p], c))) + missed;
        most = std::max(most, HalfReflectance(i, c) * off);
      }
      influence[row.panels[p]] += weight * most;
    }
  }
  return influence;
}

}  // namespace flatlight
