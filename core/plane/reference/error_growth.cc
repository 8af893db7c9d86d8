// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/error_growth.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/plane/reference/panel_light.h"

namespace flatlight {
namespace {

constexpr std::size_t kNodes = kLightCoefficients;
// A bound may lack so much of the source.
constexpr double kMostLack = 0.1;
constexpr int kMostLooks = 40;
constexpr double kTolerance = 1e-6;
// No source counts as smaller than that part of the largest.
constexpr double kLeastSource = 1e-12;

}  // namespace

ErrorGrowth::ErrorGrowth(const std::vector<Row>& rows, std::size_t channel, std::vector<double> source,
                         std::vector<double> half_reflectance, std::optional<std::uint32_t> bounces)
    : rows_(rows),
      channel_(channel),
      source_(std::move(source)),
      half_(std::move(half_reflectance)),
      bounces_(bounces.value_or(0)),
      all_bounces_(!bounces),
      bounds_(half_.size(), 0.0),
      equations_(half_.size()) {
  double most = 0;
  for (const double s : source_) most = std::max(most, s);
  for (double& s : source_)
    if (s > 0) s = std::max(s, kLeastSource * most);
}

void ErrorGrowth::Look(std::size_t i) {
  Equation& equation = equations_[i];
  equation.wanted = equation.lack = 0;
  std::size_t worst = i * kNodes;
  for (std::size_t r = i * kNodes; r < (i + 1) * kNodes; ++r) {
    const Row& row = rows_[r];
    double sum = 0;
    for (std::size_t e = 0; e < row.panels.size(); ++e)
      sum += row.Tint(e, channel_) * row.low[e * kNodes] * bounds_[row.panels[e]];
    const double wanted = source_[r] + half_[i] * sum;
    if (wanted > equation.wanted) equation.wanted = wanted, worst = r;
    const double lack = wanted - bounds_[i];
    if (lack > 0) equation.lack = std::max(equation.lack, lack / source_[r]);
  }
  if (!all_bounces_) return;
  const Row& row = rows_[worst];
  equation.source = source_[worst];
  equation.panels = row.panels;
  equation.shares.resize(row.panels.size());
  for (std::size_t e = 0; e < row.panels.size(); ++e) equation.shares[e] = row.Tint(e, channel_) * row.low[e * kNodes];
}

// w/(1 - l) is a bound if no node lacks more than the part l of its source.
bool ErrorGrowth::Raise() {
  double lack = 0;
  for (const Equation& equation : equations_) lack = std::max(lack, equation.lack);
  if (lack > kMostLack && (looks_ < kMostLooks || !all_bounces_)) return false;
  const double factor = lack < 1 ? 1 / (1 - lack) : std::numeric_limits<double>::infinity();
  for (double& w : bounds_) w *= factor;
  return true;
}

bool ErrorGrowth::Step(const Loop& loop) {
  if (minimiser_) {
    const bool done = minimiser_->Step([&](const std::vector<double>& in, std::vector<double>& out) {
      out.resize(in.size());
      loop(in.size(), [&](std::size_t i) {
        const Equation& equation = equations_[i];
        double sum = 0;
        for (std::size_t e = 0; e < equation.panels.size(); ++e) sum += equation.shares[e] * in[equation.panels[e]];
        out[i] = in[i] - half_[i] * sum;
      });
    });
    if (!done) return false;
    for (std::size_t i = 0; i < bounds_.size(); ++i) bounds_[i] = std::max(minimiser_->solution()[i], 0.0);
    minimiser_.reset();
    return false;
  }
  loop(bounds_.size(), [this](std::size_t i) { Look(i); });
  ++looks_;
  if (!all_bounces_) {
    // Fewer looks than bounces bound all of them only where nothing is lacking.
    if (bounces_ == 0 || Raise()) return true;
    --bounces_;
    for (std::size_t i = 0; i < bounds_.size(); ++i) bounds_[i] = equations_[i].wanted;
    return bounces_ == 0;
  }
  if (Raise()) return true;
  std::vector<double> source(bounds_.size()), start(bounds_.size());
  for (std::size_t i = 0; i < bounds_.size(); ++i) source[i] = equations_[i].source, start[i] = equations_[i].wanted;
  if (looks_ % 2 == 0) {
    // Where bounds are small beside others they come out better that way.
    bounds_ = std::move(start);
    return false;
  }
  minimiser_.emplace(std::move(source), std::move(start), kTolerance);
  return false;
}

}  // namespace flatlight
