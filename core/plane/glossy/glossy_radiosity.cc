// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/glossy_radiosity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/tolerances.h"
#include "core/plane/reference/quadrature.h"

namespace flatlight {
namespace {

constexpr std::size_t kN = kLightCoefficients, kD = kDirectionCoefficients;
static_assert(kN == kD, "one rule serves both");

// A kink anywhere moves the mean of what is known by about that much of the last coefficients, at most.
constexpr double kOfLast = 0.3;
constexpr double kRounding = 64 * kUnitRoundoff;
// Reflections that count when residuals are weighed: what to split needs no more.
constexpr int kReflections = 40;

// Gauss points, then those between them.
const std::vector<double>& CheckPoints() {
  static const auto& points = *new std::vector<double>([] {
    std::vector<double> made = Gauss(kN).node;
    const std::vector<double> between = PointsBetween(Gauss(kN));
    made.insert(made.end(), between.begin(), between.end());
    return made;
  }());
  return points;
}

std::vector<double> DirectionsAt(const CellMesh& mesh, std::size_t panel, const std::vector<double>& points) {
  const PanelMesh::Range range = mesh.CellsOf(panel);
  std::vector<double> directions;
  for (std::size_t i = range.first; i < range.last; ++i) {
    if (mesh.cells()[i].directions == 1) return {0};
    for (const double y : points) directions.push_back(mesh.cells()[i].At(y));
  }
  return directions;
}

// Light on the rays of a row.
void LightOn(const ScatterRow& row, const GlossyLight& light, std::vector<double>& on_rays) {
  on_rays.resize(row.rays.size());
  for (std::size_t i = 0; i < row.rays.size(); ++i) {
    const ScatterRow::Seen& ray = row.rays[i];
    on_rays[i] = ray.cell == IncomingRay::kNoCell ? 0 : light.At(ray.cell, ray.x, ray.y);
  }
}

}  // namespace

GlossyRadiosity::GlossyRadiosity(const Scene& scene, CellMesh mesh, std::size_t channels, double tolerance,
                                 std::vector<Values> start)
    : scene_(scene),
      mesh_(std::move(mesh)),
      channels_(channels),
      tolerance_(tolerance),
      start_(std::move(start)),
      rows_(mesh_.panels().size() * kN),
      means_(mesh_.cells().size()),
      largest_(channels, Values(mesh_.cells().size(), 0.0)),
      off_(mesh_.cells().size()),
      spread_(channels, Values(mesh_.cells().size(), 0.0)) {
  std::size_t checked = 0;
  for (const DirectionCell& cell : mesh_.cells()) {
    first_checked_.push_back(checked);
    checked += CheckPoints().size() * (cell.directions == 1 ? 1 : CheckPoints().size());
  }
  residual_values_.assign(channels, Values(checked, 0.0));
  if (start_.empty()) start_.assign(channels, Values(mesh_.numbers(), 0.0));
}

double GlossyRadiosity::Reflectance(std::size_t panel, std::size_t channel) const {
  return scene_.curve_of(mesh_.panels().panels()[panel].element).reflectance.value[channel];
}

void GlossyRadiosity::Build(ScatterRowBuilder& builder, std::size_t panel) {
  const std::vector<double>& nodes = Gauss(kN).node;
  const std::vector<double> directions = DirectionsAt(mesh_, panel, nodes);
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < kN; ++k) {
    ScatterRow& row = rows_[panel * kN + k];
    builder.Build(mesh_, panel, nodes[k], directions, row);
    bytes += sizeof(ScatterRow) + row.bytes();
  }
  const PanelMesh::Range range = mesh_.CellsOf(panel);
  Values sums(mesh_.cells().size());
  for (std::size_t i = range.first; i < range.last; ++i) {
    const DirectionCell& cell = mesh_.cells()[i];
    std::fill(sums.begin(), sums.end(), 0.0);
    for (std::size_t k = 0; k < kN; ++k) {
      const ScatterRow& row = RowOf(panel, k);
      for (std::size_t d = 0; d < cell.directions; ++d) {
        const ScatterRow::Band& band = row.bands[(i - range.first) * kD + d];
        for (std::size_t j = 0; j < band.count; ++j)
          if (row.rays[band.ray + j].cell != IncomingRay::kNoCell)
            sums[row.rays[band.ray + j].cell] += row.weights[band.begin + j];
      }
    }
    for (std::size_t j = 0; j < sums.size(); ++j)
      if (sums[j] > 0)
        means_[i].emplace_back(static_cast<std::uint32_t>(j), sums[j] / static_cast<double>(cell.numbers()));
    bytes += means_[i].size() * sizeof(means_[i][0]);
  }
  bytes_ += bytes;
}

void GlossyRadiosity::Transport(const Loop& loop, std::size_t channel, const Values& values, Values& out) const {
  const GlossyLight light(mesh_, Gauss(kN).node, values);
  out.resize(mesh_.numbers());
  loop(mesh_.panels().size(), [&](std::size_t panel) {
    const double reflectance = Reflectance(panel, channel);
    const PanelMesh::Range range = mesh_.CellsOf(panel);
    std::vector<double> on_rays;
    for (std::size_t k = 0; k < kN; ++k) {
      const ScatterRow& row = RowOf(panel, k);
      LightOn(row, light, on_rays);
      for (std::size_t i = range.first; i < range.last; ++i) {
        const DirectionCell& cell = mesh_.cells()[i];
        for (std::size_t d = 0; d < cell.directions; ++d)
          out[cell.first + k * cell.directions + d] =
              reflectance * row.Scatter((i - range.first) * kD + d, on_rays.data());
      }
    }
  });
}

bool GlossyRadiosity::Solve(const Loop& loop) {
  if (!minimiser_) {
    Values source(mesh_.numbers());
    for (std::size_t panel = 0; panel < mesh_.panels().size(); ++panel) {
      const PanelMesh::Range range = mesh_.CellsOf(panel);
      for (std::size_t i = range.first; i < range.last; ++i) {
        const DirectionCell& cell = mesh_.cells()[i];
        for (std::size_t k = 0; k < kN; ++k)
          for (std::size_t d = 0; d < cell.directions; ++d)
            source[cell.first + k * cell.directions + d] =
                Reflectance(panel, channel_) * RowOf(panel, k).source[(i - range.first) * kD + d].value[channel_];
      }
    }
    minimiser_.emplace(std::move(source), std::move(start_[channel_]), tolerance_);
  }
  const bool done = minimiser_->Step([&](const Values& in, Values& out) {
    Transport(loop, channel_, in, out);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = in[i] - out[i];
  });
  if (!done) return false;
  values_.push_back(minimiser_->solution());
  lights_.emplace_back(mesh_, Gauss(kN).node, values_.back());
  double most = 0;
  for (const double value : values_.back()) most = std::max(most, std::abs(value));
  brightest_.push_back(most);
  minimiser_.reset();
  if (++channel_ < channels_) return false;
  channel_ = 0;
  return true;
}

void GlossyRadiosity::Check(ScatterRowBuilder& builder, std::size_t panel) {
  const std::vector<double>& points = CheckPoints();
  const std::vector<double> directions = DirectionsAt(mesh_, panel, points);
  const PanelMesh::Range range = mesh_.CellsOf(panel);
  ScatterRow row;
  std::vector<double> on_rays;
  for (std::size_t k = 0; k < points.size(); ++k) {
    builder.Build(mesh_, panel, points[k], directions, row);
    for (std::size_t c = 0; c < channels_; ++c) {
      const double reflectance = Reflectance(panel, c);
      if (brightest_[c] == 0) continue;
      LightOn(row, lights_[c], on_rays);
      for (std::size_t i = range.first; i < range.last; ++i) {
        const std::size_t count = mesh_.cells()[i].directions == 1 ? 1 : points.size();
        for (std::size_t d = 0; d < count; ++d) {
          const std::size_t j = (i - range.first) * points.size() + d;
          const double received = reflectance * (row.Scatter(j, on_rays.data()) + row.source[j].value[c]);
          const double residual = received - lights_[c].At(i, points[k], points[d]), off = std::abs(residual);
          residual_values_[c][first_checked_[i] + k * count + d] = residual;
          largest_[c][i] = std::max(largest_[c][i], off);
          const double relative = off / brightest_[c];
          // Points that are Gauss points of directions show what places lack, and the other way round.
          if (d < kD && k >= kN) off_[i].between_places = std::max(off_[i].between_places, relative);
          if (d >= kD && k < kN) off_[i].between_directions = std::max(off_[i].between_directions, relative);
        }
      }
    }
  }
}

void GlossyRadiosity::EndCheck() {
  for (std::size_t c = 0; c < channels_; ++c) {
    residuals_.emplace_back(mesh_, CheckPoints(), residual_values_[c]);
    missed_.emplace_back();
    for (std::size_t i = 0; i < mesh_.cells().size(); ++i) missed_[c].push_back(kOfLast * residuals_[c].Last(i));
  }
}

void GlossyRadiosity::Spread(std::size_t panel) {
  const PanelMesh::Range range = mesh_.CellsOf(panel);
  std::vector<double> known, missed;
  for (std::size_t c = 0; c < channels_; ++c) {
    const double reflectance = Reflectance(panel, c);
    for (std::size_t k = 0; k < kN; ++k) {
      const ScatterRow& row = RowOf(panel, k);
      LightOn(row, residuals_[c], known);
      missed.resize(known.size());
      for (std::size_t j = 0; j < missed.size(); ++j)
        missed[j] = row.rays[j].cell == IncomingRay::kNoCell ? 0 : missed_[c][row.rays[j].cell];
      for (std::size_t i = range.first; i < range.last; ++i) {
        for (std::size_t d = 0; d < mesh_.cells()[i].directions; ++d) {
          // Cells may cancel by chance, but near it do so no better than what has either sign.
          const ScatterRow::Band& band = row.bands[(i - range.first) * kD + d];
          double all = 0, squares = 0, of_cell = 0;
          for (std::size_t j = 0; j < band.count; ++j) {
            of_cell += row.weights[band.begin + j] * known[band.ray + j];
            if (j + 1 < band.count && row.rays[band.ray + j + 1].cell == row.rays[band.ray + j].cell) continue;
            all += of_cell, squares += of_cell * of_cell;
            of_cell = 0;
          }
          const double of_known = std::max(std::abs(all), std::sqrt(squares));
          const double of_missed = row.Scatter((i - range.first) * kD + d, missed.data());
          spread_[c][i] = std::max(spread_[c][i], reflectance * (kBetween * of_known + of_missed));
        }
      }
    }
  }
}

void GlossyRadiosity::TransportMost(const Loop& loop, std::size_t channel, const Values& values, Values& out) const {
  loop(mesh_.panels().size(), [&](std::size_t panel) {
    const double reflectance = Reflectance(panel, channel);
    const PanelMesh::Range range = mesh_.CellsOf(panel);
    std::vector<double> on_rays;
    for (std::size_t i = range.first; i < range.last; ++i) out[i] = 0;
    for (std::size_t k = 0; k < kN; ++k) {
      const ScatterRow& row = RowOf(panel, k);
      on_rays.resize(row.rays.size());
      for (std::size_t j = 0; j < row.rays.size(); ++j)
        on_rays[j] = row.rays[j].cell == IncomingRay::kNoCell ? 0 : values[row.rays[j].cell];
      for (std::size_t i = range.first; i < range.last; ++i)
        for (std::size_t d = 0; d < mesh_.cells()[i].directions; ++d)
          out[i] = std::max(out[i], reflectance * row.Scatter((i - range.first) * kD + d, on_rays.data()));
    }
  });
}

bool GlossyRadiosity::Bound(const Loop& loop) {
  if (!majorant_) {
    Values g = spread_[channel_];
    for (double& w : g) w = kBetween * w + kRounding * brightest_[channel_];
    majorant_.emplace(std::move(g));
  }
  const bool done = majorant_->Step([&](const Values& in, Values& out) { TransportMost(loop, channel_, in, out); });
  if (!done) return false;
  bounds_.push_back(majorant_->values());
  majorant_.reset();
  return ++channel_ == channels_;
}

GlossyRadiosity::Values GlossyRadiosity::Shares(std::size_t channel, const Values& direct) const {
  Values all = direct, term = direct, next(direct.size());
  for (int k = 0; k < kReflections; ++k) {
    std::fill(next.begin(), next.end(), 0.0);
    for (std::size_t i = 0; i < term.size(); ++i) {
      if (term[i] == 0) continue;
      const double through = term[i] * Reflectance(mesh_.cells()[i].panel, channel);
      for (const auto& [cell, mean] : means_[i]) next[cell] += through * mean;
    }
    for (std::size_t i = 0; i < term.size(); ++i) all[i] += next[i];
    term.swap(next);
  }
  for (std::size_t i = 0; i < all.size(); ++i) all[i] *= largest_[channel][i];
  return all;
}

std::vector<GlossyRadiosity::Values> GlossyRadiosity::OnNodesOf(const CellMesh& mesh) const {
  std::vector<Values> all(channels_, Values(mesh.numbers()));
  const std::vector<double>& nodes = Gauss(kN).node;
  for (const DirectionCell& cell : mesh.cells()) {
    const Panel& panel = mesh.panels().panels()[cell.panel];
    const PanelMesh::Range range = mesh_.panels().On(panel.element, panel.side);
    for (std::size_t k = 0; k < kN; ++k) {
      const double u = panel.At(nodes[k]);
      std::size_t i = range.first;
      while (i + 1 < range.last && mesh_.panels().panels()[i].high <= u) ++i;
      for (std::size_t d = 0; d < cell.directions; ++d) {
        const double t = cell.At(nodes[d]);
        const std::size_t from = mesh_.CellAt(i, t);
        for (std::size_t c = 0; c < channels_; ++c)
          all[c][cell.first + k * cell.directions + d] =
              lights_[c].At(from, mesh_.panels().panels()[i].Local(u), mesh_.cells()[from].Local(t));
      }
    }
  }
  return all;
}

}  // namespace flatlight
