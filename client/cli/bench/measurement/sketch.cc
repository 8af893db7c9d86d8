// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/measurement/sketch.h"

#include <cmath>

#include "client/cli/statistics/distributions.h"
#include "client/cli/statistics/moments.h"

namespace flatlight {
namespace {

// 64 bits that look random: the finaliser of SplitMix64 (G. Steele, D. Lea, C. Flood, OOPSLA 2014).
std::uint64_t Mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

}  // namespace

void Sketch::Add(double error) {
  const std::uint64_t signs = Mix(count_++);
  for (int k = 0; k < kProjections; ++k) sums_[static_cast<std::size_t>(k)] += (signs >> k & 1) != 0 ? error : -error;
}

std::vector<double> Sketch::Projections() const {
  std::vector<double> projections = sums_;
  for (double& value : projections) value /= std::sqrt(static_cast<double>(count_));
  return projections;
}

std::optional<BiasEstimate> EstimateBias(const std::vector<std::vector<double>>& sketches, double truth_rms) {
  if (sketches.size() < 2) return std::nullopt;
  for (const std::vector<double>& sketch : sketches)
    if (sketch.size() != Sketch::kProjections) return std::nullopt;
  const auto runs = static_cast<double>(sketches.size());
  double mean_square = 0, variance = 0;
  for (std::size_t k = 0; k < Sketch::kProjections; ++k) {
    std::vector<double> values;
    values.reserve(sketches.size());
    for (const std::vector<double>& sketch : sketches) values.push_back(sketch[k]);
    const Moments moments = MomentsOf(values);
    mean_square += moments.mean * moments.mean / Sketch::kProjections;
    variance += moments.variance / Sketch::kProjections;
  }
  BiasEstimate bias;
  bias.rms = std::sqrt(mean_square);
  bias.noise_rms = std::sqrt(variance / runs + truth_rms * truth_rms);
  // Projections of errors of independent points are uncorrelated and nearly normal, with one variance.
  if (bias.noise_rms > 0) {
    const double ratio = bias.rms / bias.noise_rms;
    bias.probability = FisherTail(ratio * ratio, Sketch::kProjections, Sketch::kProjections * (runs - 1));
  } else if (mean_square > 0) {
    bias.probability = 0;
  }
  return bias;
}

}  // namespace flatlight
