// SPDX-License-Identifier: Apache-2.0
// What a solution leaves over, and bounds on what that comes to.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/plane/reference/error_sum.h"
#include "core/plane/reference/quadrature.h"
#include "core/plane/reference/radiosity.h"

namespace flatlight {
namespace {

// The largest value at nodes need not be that of the panel, nor the residual's polynomial the residual.
constexpr double kCaution = ErrorSum::kCaution;
// At a kink coefficients fall by the square of their number; beside the last ones, so much of the mean may be missed.
constexpr double kMissed = 0.3;
// What matters by way of so many others, or more, is left out when panels are chosen.
constexpr int kImportanceBounces = 8;

}  // namespace

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
  static const auto& points = *new std::vector<double>(NodesAndBetween(Gauss(kNodes)));
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
      errors_.residual.Of(i, c)[k] = sum;
      first_residual_.Of(i, c)[k] = sum_first;
    }
    // Where the first coefficients are no larger than the last ones nothing is known of the rest.
    double& missed = errors_.missed[i * channels_ + c];
    for (const PanelLight* left : {&errors_.residual, &first_residual_}) {
      double largest = 0, last = 0;
      for (std::size_t k = 0; k < kResidualCoefficients; ++k) largest = std::max(largest, std::abs(left->Of(i, c)[k]));
      for (std::size_t k = kResidualCoefficients - 3; k < kResidualCoefficients; ++k)
        last = std::max(last, std::abs(left->Of(i, c)[k]));
      if (largest > 0) missed = std::max(missed, kMissed * last * (1 + last / largest));
    }
    CheckCells(i, c);
    double& size = errors_.size[i * channels_ + c];
    size = errors_.most[i * channels_ + c];
    double& steep = errors_.steep[i * channels_ + c];
    for (const double x : points) {
      double all[kResidualCoefficients], slopes[kResidualCoefficients];
      LegendreWithSlopes(x, kResidualCoefficients, all, slopes);
      size = std::max(size, kCaution * std::abs(errors_.residual.At(i, c, all)));
      steep = std::max(steep, kCaution * std::abs(errors_.residual.At(i, c, slopes)));
    }
  }
}

// Beside what the polynomial of the residual says there may be more between two events.
void Radiosity::CheckCells(std::size_t i, std::size_t c) {
  const Panel& panel = mesh_.panels()[i];
  double mean = 0, square = 0, most = 0, sum = 0, of_either_sign = 0;
  for (std::size_t k = 0; k < cells_[i].size(); ++k) {
    Cell& cell = cells_[i][k];
    double off = 0, rounding = 0, p[kResidualCoefficients];
    Legendre(panel.Local(cell.place), kResidualCoefficients, p);
    CheckAt(i, rows_.cells[i][k], p, c, off, rounding);
    const double beside = off - errors_.residual.At(i, c, p);
    off = kCaution * (std::abs(beside) - rounding);
    if (!(off > 0)) continue;
    const double share = (cell.high - cell.low) / (panel.high - panel.low);
    sum += share * std::copysign(off, beside);
    of_either_sign += share * share * off * off;
    cell.off = std::max(cell.off, off);
    most = std::max(most, off);
    mean += share * off;
    square += share * off * off;
  }
  errors_.mean[i * channels_ + c] = mean;
  errors_.in_all[i * channels_ + c] = std::min(mean, std::abs(sum) + std::sqrt(of_either_sign));
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
      const double half = HalfReflectance(i, c);
      spread_[r * channels_ + c] = half * (max_bounces_ ? std::max(all.total(), of_first.total()) : all.rest());
      correction_[r * channels_ + c] = half * all.sum();
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

double Radiosity::MostReflected(std::size_t panel, const Row& row, std::size_t entry) const {
  double most = 0;
  for (std::size_t c = 0; c < channels_; ++c) most = std::max(most, HalfReflectance(panel, c) * row.Tint(entry, c));
  return most;
}

void Radiosity::AddByWayOfOthers(std::vector<double>& importance) const {
  const std::vector<double> straight = importance;
  std::vector<double> before;
  for (int bounce = 0; bounce < kImportanceBounces; ++bounce) {
    before.swap(importance);
    importance = straight;
    for (std::size_t i = 0; i < mesh_.size(); ++i) {
      const double own = bounce == 0 ? straight[i] : before[i];
      if (own == 0) continue;
      const Row& row = rows_.nodes[i * kNodes + kNodes / 2];
      for (std::size_t p = 0; p < row.panels.size(); ++p)
        importance[row.panels[p]] += own * MostReflected(i, row, p) * row.low[p * kNodes];
    }
  }
}

std::vector<double> Radiosity::Influence(std::vector<double> importance) const {
  AddByWayOfOthers(importance);
  std::vector<double> influence(mesh_.size(), 0.0), largest(mesh_.size(), 0.0);
  std::vector<std::uint32_t> seen;
  for (std::size_t i = 0; i < mesh_.size(); ++i) {
    if (importance[i] == 0) continue;
    for (std::size_t r = i * kNodes; r < (i + 1) * kNodes; ++r) {
      const Row& row = rows_.nodes[r];
      for (std::size_t p = 0; p < row.panels.size(); ++p) {
        const std::size_t j = row.panels[p];
        double most = 0;
        for (std::size_t c = 0; c < channels_; ++c) {
          const double missed = errors_.Missed(j * channels_ + c, &row.low[p * kNodes]);
          const double known = row.Times(p, errors_.residual.Of(j, c));
          most = std::max(most, HalfReflectance(i, c) * row.Tint(p, c) * ErrorSum::RestOf(known, missed));
        }
        if (largest[j] == 0) seen.push_back(row.panels[p]);
        largest[j] = std::max(largest[j], most);
      }
    }
    for (const std::uint32_t j : seen) influence[j] += importance[i] * largest[j], largest[j] = 0;
    seen.clear();
  }
  return influence;
}

}  // namespace flatlight
