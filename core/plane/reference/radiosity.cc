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

constexpr std::size_t kNodes = kLightCoefficients;
// The largest value at nodes need not be that of the panel, nor the residual's polynomial the residual.
constexpr double kCaution = 2;
// Above this the largest bounds of all panels would add up to far more than there is.
constexpr double kReflectsMuch = 0.8;
// At a kink coefficients fall by the square of their number; beside the last ones, so much of the mean may be missed.
constexpr double kMissed = 0.3;
// Of radiance that may grow without end: its square is a number still.
constexpr double kNoBound = 1e30;
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
      to_residual_(CoefficientsFromValues(NodesAndBetween())),
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
      spread_(mesh_.size() * kNodes * channels) {
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
  for (auto* values : {&errors_.mean, &errors_.root_mean_square, &errors_.most})
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
  rows_ = {};
  positive_ = {};
}

double Radiosity::HalfReflectance(std::size_t panel, std::size_t channel) const {
  return 0.5 * scene_.curve_of(mesh_.panels()[panel].element).reflectance.value[channel];
}

void Radiosity::BuildRows(RowBuilder& builder, std::size_t i, std::size_t n) {
  const Panel& panel = mesh_.panels()[i];
  const Chart& chart = charts_[static_cast<std::size_t>(panel.element)];
  static const auto& points = *new std::vector<double>(NodesAndBetween());
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
  // Mirrors that emit may meet light again and again.
  errors_.brightest.value[c] = (emitted + reflected) * std::min(GlowGrowth(scene_).value[c], kNoBound);
  keep(accumulation_->values(), light_);
  keep(accumulation_->before(), before_);
  keep(source(), first_);
  accumulation_.reset();
  if (++channel_ < channels_) return false;
  channel_ = 0;
  start_.clear();
  return true;
}

// What is left over at the place where the row was made and the polynomials are p, and rounding there.
void Radiosity::CheckAt(std::size_t i, const Row& row, const double* p, std::size_t c, double& residual,
                        double& rounding) const {
  const double half = HalfReflectance(i, c), direct = row.direct.value[c];
  double sum = 0, size = direct, brightest = row.brightest.value[c];
  for (std::size_t e = 0; e < row.panels.size(); ++e) {
    const double* light = before_.Of(row.panels[e], c);
    sum += row.Tint(e, c) * row.TimesLight(e, light);
    size += row.Tint(e, c) * row.low[e * kNodes] * std::abs(light[0]);
    brightest = std::max(brightest, brightest_[row.panels[e] * channels_ + c]);
  }
  residual = half * (direct + sum) - light_.At(i, c, p);
  rounding = half * (kRounding * size + row.coordinates * brightest) + UnfollowedAt(i, row, c);
}

void Radiosity::Check(std::size_t i) {
  static const auto& points = *new std::vector<double>(NodesAndBetween());
  double p[kNodes], residual[kMaxChannels][kResidualCoefficients] = {}, first[kMaxChannels][kResidualCoefficients] = {};
  for (std::size_t n = 0; n < points.size(); ++n) {
    const bool node = n % 2 == 1;
    const Row& row = node ? rows_.nodes[i * kNodes + n / 2] : rows_.between[i * (kNodes + 1) + n / 2];
    Legendre(points[n], kNodes, p);
    for (std::size_t c = 0; c < channels_; ++c) {
      double rounding_here = 0;
      CheckAt(i, row, p, c, residual[c][n], rounding_here);
      double& rounding = rounding_[i * channels_ + c];
      rounding = std::max(rounding, rounding_here);
      double& unfollowed = unfollowed_[i * channels_ + c];
      unfollowed = std::max(unfollowed, UnfollowedAt(i, row, c));
      if (!node) {
        first[c][n] = HalfReflectance(i, c) * row.direct.value[c] - first_.At(i, c, p);
      } else if (std::abs(residual[c][n]) <= rounding_here) {
        // At nodes nothing is left over but rounding and what the solver leaves.
        residual[c][n] = 0;
      }
    }
  }
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t k = 0; k < kResidualCoefficients; ++k) {
      double sum = 0, sum_first = 0;
      for (std::size_t n = 0; n < kResidualCoefficients; ++n) {
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
    CheckCells(i, c);
    double& size = errors_.size[i * channels_ + c];
    size = errors_.most[i * channels_ + c];
    double& steep = errors_.steep[i * channels_ + c];
    for (const double x : points) {
      double all[kResidualCoefficients], slopes[kResidualCoefficients];
      LegendreWithSlopes(x, kResidualCoefficients, all, slopes);
      size = std::max(size, std::abs(errors_.residual.At(i, c, all)));
      steep = std::max(steep, std::abs(errors_.residual.At(i, c, slopes)));
    }
  }
}

// Beside what the polynomial of the residual says there may be more between two events.
void Radiosity::CheckCells(std::size_t i, std::size_t c) {
  const Panel& panel = mesh_.panels()[i];
  double mean = 0, square = 0, most = 0;
  for (std::size_t k = 0; k < cells_[i].size(); ++k) {
    Cell& cell = cells_[i][k];
    double off = 0, rounding = 0, p[kResidualCoefficients];
    Legendre(panel.Local(cell.place), kResidualCoefficients, p);
    CheckAt(i, rows_.cells[i][k], p, c, off, rounding);
    off = kCaution * (std::abs(off - errors_.residual.At(i, c, p) / kCaution) - rounding);
    if (!(off > 0)) continue;
    const double share = (cell.high - cell.low) / (panel.high - panel.low);
    cell.off = std::max(cell.off, off);
    most = std::max(most, off);
    mean += share * off;
    square += share * off * off;
  }
  errors_.mean[i * channels_ + c] = mean;
  errors_.root_mean_square[i * channels_ + c] = std::sqrt(square);
  errors_.most[i * channels_ + c] = most;
}

void Radiosity::Spread(std::size_t i) {
  if (!positive_.empty())
    for (std::size_t r = i * kNodes; r < (i + 1) * kNodes; ++r) FindPositive(r);
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t r = i * kNodes; r < (i + 1) * kNodes; ++r) {
      const Row& row = rows_.nodes[r];
      ErrorSum all, of_first;
      for (std::size_t p = 0; p < row.panels.size(); ++p) {
        const double tint = row.Tint(p, c);
        const double missed = tint * errors_.Missed(row.panels[p] * channels_ + c, &row.low[p * kNodes]);
        all.Add(tint * row.Times(p, errors_.residual.Of(row.panels[p], c)), missed);
        if (max_bounces_) of_first.Add(tint * row.Times(p, first_residual_.Of(row.panels[p], c)), missed);
      }
      spread_[r * channels_ + c] = HalfReflectance(i, c) * std::max(all.total(), of_first.total());
    }
  }
}

bool Radiosity::Bound(const Loop& loop) {
  if (channel_ == channels_) return true;
  const std::size_t c = channel_;
  const auto source = [&] {
    Values values(rows_.nodes.size());
    for (std::size_t r = 0; r < values.size(); ++r) {
      const std::size_t at = r / kNodes * channels_ + c;
      values[r] = spread_[r * channels_ + c] + rounding_[at] + (max_bounces_ ? kRounding * brightest_[at] : 0);
    }
    return values;
  };
  if (scene_.traits().max_reflectance > kReflectsMuch) {
    if (max_bounces_) {
      if (!Accumulate(loop, source, {}, 0)) return false;
    } else {
      if (!majorant_) majorant_.emplace(source(), NodeWeights(), scene_.traits().max_reflectance);
      const bool done = majorant_->Step([&](const Values& in, Values& out) { TransportPositive(loop, c, in, out); });
      if (!done) return false;
    }
    const Values& bounds = max_bounces_ ? accumulation_->values() : majorant_->bounds();
    for (std::size_t i = 0; i < mesh_.size(); ++i) {
      double most = 0;
      for (std::size_t k = 0; k < kNodes; ++k) most = std::max(most, std::abs(bounds[i * kNodes + k]));
      errors_.value[i * channels_ + c] = most;
    }
    accumulation_.reset();
    majorant_.reset();
  } else {
    if (!growth_) {
      Values half(mesh_.size());
      for (std::size_t i = 0; i < mesh_.size(); ++i) half[i] = HalfReflectance(i, c);
      growth_.emplace(rows_.nodes, c, source(), std::move(half), max_bounces_);
    }
    if (!growth_->Step(loop)) return false;
    for (std::size_t i = 0; i < mesh_.size(); ++i) errors_.value[i * channels_ + c] = growth_->bounds()[i];
    growth_.reset();
  }
  return ++channel_ == channels_;
}

double Radiosity::UnfollowedPart(std::size_t c) const {
  double unfollowed = 0, all = 0;
  const Values weights = NodeWeights();
  for (std::size_t r = 0; r < weights.size(); ++r) {
    const std::size_t at = r / kNodes * channels_ + c;
    unfollowed += weights[r] * unfollowed_[at];
    all += weights[r] * (spread_[r * channels_ + c] + rounding_[at]);
  }
  return all > 0 ? unfollowed / all : 0;
}

std::vector<double> Radiosity::Influence() const {
  std::vector<double> influence(mesh_.size(), 0.0);
  const Values weights = NodeWeights();
  for (std::size_t r = 0; r < rows_.nodes.size(); ++r) {
    const std::size_t i = r / kNodes;
    const double weight = weights[r];
    const Row& row = rows_.nodes[r];
    for (std::size_t p = 0; p < row.panels.size(); ++p) {
      double most = 0;
      for (std::size_t c = 0; c < channels_; ++c) {
        const double missed = errors_.Missed(row.panels[p] * channels_ + c, &row.low[p * kNodes]);
        const double off = std::abs(row.Times(p, errors_.residual.Of(row.panels[p], c))) + missed;
        most = std::max(most, HalfReflectance(i, c) * row.Tint(p, c) * off);
      }
      influence[row.panels[p]] += weight * most;
    }
  }
  return influence;
}

}  // namespace flatlight
