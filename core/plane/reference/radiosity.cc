// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/radiosity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/check.h"
#include "core/math/tolerances.h"
#include "core/plane/reference/error_sum.h"
#include "core/plane/reference/index_growth.h"
#include "core/plane/reference/quadrature.h"

namespace flatlight {
namespace {

// To which what the residual gives is reflected on, of itself.
constexpr double kCorrectionTolerance = 1e-3;
// Of radiance that may grow without end: its square is a number still.
constexpr double kNoBound = 1e30;

// Mirrors that emit may meet light again and again.
double GrowthByGlow(const Scene& scene, std::size_t channel) {
  return std::min(GlowGrowth(scene).value[channel], kNoBound);
}

}  // namespace

Radiosity::Radiosity(const RayCaster& caster, const std::vector<Chart>& charts, const Events& events, PanelMesh mesh,
                     std::size_t channels, std::optional<std::uint32_t> max_bounces, double tolerance,
                     Radiosity* before)
    : scene_(caster.scene()),
      charts_(charts),
      events_(events),
      mesh_(std::move(mesh)),
      cells_(mesh_.size()),
      channels_(channels),
      max_bounces_(max_bounces),
      to_coefficients_(CoefficientsFromValues(Gauss(kNodes).node)),
      to_residual_(CoefficientsFromValues(NodesAndBetween(Gauss(kNodes)))),
      tolerance_(tolerance),
      rows_{std::vector<Row>(mesh_.size() * kNodes), std::vector<Row>(mesh_.size() * (kNodes + 1)),
            std::vector<std::vector<Row>>(mesh_.size())},
      brightest_(mesh_.size() * channels, 0.0),
      light_(mesh_.size(), channels, kNodes),
      first_(mesh_.size(), channels, kNodes),
      before_(mesh_.size(), channels, kNodes),
      first_residual_(mesh_.size(), channels, kResidualCoefficients),
      rounding_(mesh_.size() * channels),
      unfollowed_(mesh_.size() * channels),
      spread_(mesh_.size() * kNodes * channels),
      correction_(mesh_.size() * kNodes * channels) {
  FLATLIGHT_DCHECK(mesh_.size() == 0 || (CanFollow(scene_) && max_bounces != 0u));
  for (std::size_t c = 0; before && !max_bounces && c < channels; ++c) start_.push_back(before->OnNodesOf(mesh_, c));
  if (before) rows_before_ = std::move(before->rows_);
  for (std::size_t i = 0; i < mesh_.size(); ++i) {
    const Panel& panel = mesh_.panels()[i];
    cells_[i] = CellsBetween(events_[PanelMesh::IndexOf(panel.element, panel.side)], panel.low, panel.high);
    rows_.cells[i].resize(cells_[i].size());
  }
  if (scene_.traits().max_reflectance > kReflectsMuch && !max_bounces_) positive_.resize(rows_.nodes.size());
  errors_.residual = first_residual_;
  errors_.size.assign(mesh_.size() * channels, 0.0);
  errors_.steep.assign(mesh_.size() * channels, 0.0);
  errors_.missed.assign(mesh_.size() * channels, 0.0);
  for (auto* values : {&errors_.mean, &errors_.in_all, &errors_.root_mean_square, &errors_.most})
    values->assign(mesh_.size() * channels, 0.0);
  errors_.value.assign(mesh_.size() * channels, 0.0);
  errors_.slope.assign(mesh_.size() * channels, 0.0);
}

std::size_t Radiosity::memory() const {
  std::size_t entries = 0, high_entries = 0, specular_bytes = 0;
  const auto add = [&](const Row& row, std::size_t& to) {
    to += row.panels.size();
    specular_bytes += row.tints.size() * (sizeof(Spectrum) + sizeof(std::uint32_t));
    for (const SpecularPiece& piece : row.specular) specular_bytes += BytesOf(piece);
  };
  for (const Row& row : rows_.nodes) add(row, high_entries);
  for (const Row& row : rows_.between) add(row, entries);
  for (const std::vector<Row>& rows : rows_.cells)
    for (const Row& row : rows) add(row, entries);
  return (entries + high_entries) * (kNodes * sizeof(double) + sizeof(std::uint32_t)) + specular_bytes +
         high_entries * (kResidualCoefficients - kNodes + (positive_.empty() ? 0 : kNodes)) * sizeof(float);
}

void Radiosity::DropRows() {
  dropped_memory_ = memory_of_all();
  rows_ = {};
  positive_ = {};
}

double Radiosity::HalfReflectance(std::size_t panel, std::size_t channel) const {
  return 0.5 * scene_.curve_of(mesh_.panels()[panel].element).reflectance.value[channel];
}

void Radiosity::BuildRows(RowBuilder& builder, std::size_t i, std::size_t n) {
  const Panel& panel = mesh_.panels()[i];
  const Chart& chart = charts_[static_cast<std::size_t>(panel.element)];
  static const auto& points = *new std::vector<double>(NodesAndBetween(Gauss(kNodes)));
  const bool known = panel.before != Panel::kNew && !rows_before_.nodes.empty();
  const bool node = n % 2 == 1;
  const std::size_t count = node ? kNodes : kNodes + 1;
  Row* own_before = known ? &(node ? rows_before_.nodes : rows_before_.between)[panel.before * count + n / 2] : nullptr;
  Row& own = (node ? rows_.nodes : rows_.between)[i * count + n / 2];
  builder.Build(mesh_, chart.ReceiverAt(panel.element, panel.At(points[n]), panel.side), node, own_before, own);
  for (std::size_t k = n; k < cells_[i].size(); k += kRowParts) {
    Row* before = known ? &rows_before_.cells[panel.before][k] : nullptr;
    builder.Build(mesh_, chart.ReceiverAt(panel.element, cells_[i][k].place, panel.side), false, before,
                  rows_.cells[i][k]);
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
        sum += row.Tint(p, channel) * row.TimesLight(p, &coefficients[row.panels[p] * kNodes]);
      out[r] = HalfReflectance(i, channel) * sum;
    }
  });
}

// Where weights on nodes are negative these are left out, and the others take their part.
void Radiosity::FindPositive(std::size_t r) {
  const Row& row = rows_.nodes[r];
  std::vector<float>& weights = positive_[r];
  weights.resize(row.low.size());
  for (std::size_t e = 0; e < row.panels.size(); ++e) {
    const double* moments = &row.low[e * kNodes];
    double weight[kNodes], sum = 0;
    for (std::size_t n = 0; n < kNodes; ++n) {
      double w = 0;
      for (std::size_t k = 0; k < kNodes; ++k) w += moments[k] * to_coefficients_[k * kNodes + n];
      sum += weight[n] = std::max(w, 0.0);
    }
    const double factor = sum > 0 ? moments[0] / sum : 0;
    for (std::size_t n = 0; n < kNodes; ++n) weights[e * kNodes + n] = static_cast<float>(factor * weight[n]);
  }
}

void Radiosity::TransportPositive(const Loop& loop, std::size_t channel, const Values& values, Values& out) const {
  out.resize(values.size());
  loop(mesh_.size(), [&](std::size_t i) {
    for (std::size_t r = i * kNodes; r < (i + 1) * kNodes; ++r) {
      const Row& row = rows_.nodes[r];
      const float* weight = positive_[r].data();
      double sum = 0;
      for (std::size_t e = 0; e < row.panels.size(); ++e) {
        const double* from = &values[row.panels[e] * kNodes];
        double of_panel = 0;
        for (std::size_t n = 0; n < kNodes; ++n) of_panel += static_cast<double>(*weight++) * from[n];
        sum += row.Tint(e, channel) * of_panel;
      }
      out[r] = HalfReflectance(i, channel) * sum;
    }
  });
}

Radiosity::Values Radiosity::NodeWeights() const {
  const GaussRule& rule = Gauss(kNodes);
  Values weights;
  weights.reserve(rows_.nodes.size());
  for (const Panel& panel : mesh_.panels()) {
    const Chart& chart = charts_[static_cast<std::size_t>(panel.element)];
    for (std::size_t n = 0; n < kNodes; ++n)
      weights.push_back(0.5 * (panel.high - panel.low) * chart.At(panel.At(rule.node[n])).speed * rule.weight[n]);
  }
  return weights;
}

Radiosity::Values Radiosity::OnNodesOf(const PanelMesh& mesh, std::size_t channel) const {
  const GaussRule& rule = Gauss(kNodes);
  Values values;
  values.reserve(mesh.size() * kNodes);
  double p[kNodes];
  std::size_t mine = 0;  // Panels come in one order in both meshes.
  for (const Panel& panel : mesh.panels()) {
    const auto holds = [&](const Panel& other) {
      return other.element == panel.element && other.side == panel.side && other.high >= panel.high;
    };
    while (!holds(mesh_.panels()[mine])) ++mine;
    for (std::size_t n = 0; n < kNodes; ++n) {
      Legendre(mesh_.panels()[mine].Local(panel.At(rule.node[n])), kNodes, p);
      values.push_back(light_.At(mine, channel, p));
    }
  }
  return values;
}

bool Radiosity::Accumulate(const Loop& loop, const std::function<Values()>& source, const Values& start,
                           double tolerance) {
  if (!accumulation_) {
    Values first = source();
    Values guess = start.empty() ? Values(first.size(), 0.0) : start;
    accumulation_.emplace(std::move(first), max_bounces_, std::move(guess), NodeWeights(), tolerance, kRounding);
  }
  Values coefficients;
  return accumulation_->Step([&](const Values& in, Values& out) {
    ToCoefficients(in, coefficients);
    Transport(loop, channel_, coefficients, out);
  });
}

bool Radiosity::Solve(const Loop& loop) {
  rows_before_ = {};
  if (channel_ == channels_) return true;
  const std::size_t c = channel_;
  const auto source = [&] {
    Values values(rows_.nodes.size());
    for (std::size_t r = 0; r < values.size(); ++r)
      values[r] = HalfReflectance(r / kNodes, c) * rows_.nodes[r].direct.value[c];
    return values;
  };
  if (!Accumulate(loop, source, start_.empty() ? Values() : start_[c], tolerance_)) return false;
  Values coefficients;
  const auto keep = [&](const Values& values, PanelLight& light) {
    ToCoefficients(values, coefficients);
    for (std::size_t i = 0; i < mesh_.size(); ++i) std::copy_n(&coefficients[i * kNodes], kNodes, light.Of(i, c));
  };
  double reflected = 0;
  for (std::size_t r = 0; r < rows_.nodes.size(); ++r) {
    double& brightest = brightest_[r / kNodes * channels_ + c];
    brightest = std::max(brightest, std::abs(accumulation_->values()[r]));
    reflected = std::max(reflected, brightest);
  }
  double emitted = scene_.environment().value[c];
  for (const Curve& curve : scene_.curves()) emitted = std::max(emitted, curve.radiance.value[c]);
  errors_.brightest.value[c] = (emitted + reflected) * GrowthByGlow(scene_, c);
  keep(accumulation_->values(), light_);
  keep(accumulation_->before(), before_);
  keep(source(), first_);
  accumulation_.reset();
  if (++channel_ < channels_) return false;
  channel_ = 0;
  start_.clear();
  return true;
}

bool Radiosity::Correct(const Loop& loop) {
  if (max_bounces_ || channel_ == channels_) {
    channel_ = 0;
    return true;
  }
  const std::size_t c = channel_;
  const auto source = [&] {
    Values values(rows_.nodes.size());
    for (std::size_t r = 0; r < values.size(); ++r) values[r] = correction_[r * channels_ + c];
    return values;
  };
  if (!Accumulate(loop, source, {}, kCorrectionTolerance)) return false;
  const Values& values = accumulation_->values();
  Values coefficients, reflected;
  ToCoefficients(values, coefficients);
  Transport(loop, c, coefficients, reflected);
  double most = 0;
  for (std::size_t r = 0; r < values.size(); ++r) {
    spread_[r * channels_ + c] += std::abs(correction_[r * channels_ + c] + reflected[r] - values[r]);
    light_.Of(r / kNodes, c)[r % kNodes] += coefficients[r];
    most = std::max(most, std::abs(values[r]));
  }
  errors_.brightest.value[c] += most * GrowthByGlow(scene_, c);
  accumulation_.reset();
  ++channel_;
  return false;
}

}  // namespace flatlight
