// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_RADIOSITY_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_RADIOSITY_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/plane/glossy/cell_mesh.h"
#include "core/plane/glossy/glossy_light.h"
#include "core/plane/glossy/light_majorant.h"
#include "core/plane/glossy/scatter_row.h"
#include "core/plane/reference/krylov.h"
#include "core/scene/scene.h"

namespace flatlight {

// The radiance that leaves the cells of a mesh by reflection, L = b + T L with T: one reflection. It is a polynomial of
// place and direction on each, right at its Gauss points; there and between them the residual r = b + T L - L is
// measured, by finer quadrature. The error e = r + T e is r itself and e1 = T r + T e1, where |e1| is at most
// w = |T r| + T w (THEORY 18 B8), for T keeps what is positive so. r has all but no mean, so |T r| is small.
// Of r the polynomial through all points is known, with its sign, and counts twice; where its last coefficients say
// that it is not smooth, a part of these counts too, of either sign. w is a number on each cell, no less than what any
// of its Gauss points asks for.
//
// Steps, in this order: Build of all panels, Solve, Check of all panels, Spread of all panels, Bound. Steps of panels
// may run at once on several threads; Solve and Bound are called until they return true. Equal bits for any number of
// threads.
class GlossyRadiosity {
 public:
  using Values = std::vector<double>;
  // Runs work(0) ... work(count - 1).
  using Loop = std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

  // `start`: by channel, a guess at the values at the Gauss points, or empty. `tolerance`: to which the equations are
  // solved, of their right side. The scene must outlive this.
  GlossyRadiosity(const Scene& scene, CellMesh mesh, std::size_t channels, double tolerance, std::vector<Values> start);

  const CellMesh& mesh() const { return mesh_; }
  // Bytes of the rows built so far.
  std::size_t memory() const { return bytes_; }

  void Build(ScatterRowBuilder& builder, std::size_t panel);
  bool Solve(const Loop& loop);
  void Check(ScatterRowBuilder& builder, std::size_t panel);
  // Once all panels are checked.
  void EndCheck();
  void Spread(std::size_t panel);
  bool Bound(const Loop& loop);

  const GlossyLight& light(std::size_t channel) const { return lights_[channel]; }
  // The residual, where it is known, and by cell what it may be off by in the mean.
  const GlossyLight& residual(std::size_t channel) const { return residuals_[channel]; }
  const Values& missed(std::size_t channel) const { return missed_[channel]; }
  // By cell: light is off by no more beside its residual.
  const Values& bound(std::size_t channel) const { return bounds_[channel]; }
  // To the residual, as long as it is known at some points only.
  static constexpr double kBetween = 2;
  double brightest(std::size_t channel) const { return brightest_[channel]; }
  // How much each cell's largest residual would count, where an error of one on a cell counts `direct` by itself; with
  // all that it adds to the error of others. By cell.
  Values Shares(std::size_t channel, const Values& direct) const;
  // Where on a cell the residual is large: beside the Gauss points of places, or of directions. Absent if the cell
  // cannot be split in directions.
  struct Off {
    double between_places = 0, between_directions = 0;
  };
  const Off& OffAt(std::size_t cell) const { return off_[cell]; }
  // Its light at the Gauss points of another mesh, by channel.
  std::vector<Values> OnNodesOf(const CellMesh& mesh) const;

 private:
  double Reflectance(std::size_t panel, std::size_t channel) const;
  // T of a light at the Gauss points.
  void Transport(const Loop& loop, std::size_t channel, const Values& values, Values& out) const;
  // Of numbers on cells, the most at any of the Gauss points.
  void TransportMost(const Loop& loop, std::size_t channel, const Values& values, Values& out) const;
  const ScatterRow& RowOf(std::size_t panel, std::size_t node) const {
    return rows_[panel * kLightCoefficients + node];
  }

  const Scene& scene_;
  CellMesh mesh_;
  std::size_t channels_;
  double tolerance_;
  std::vector<Values> start_;
  std::atomic<std::size_t> bytes_ = 0;
  std::vector<ScatterRow> rows_;  // By panel, then Gauss point.
  // By cell: cells that it sees, and how much of their light, in the mean over its Gauss points.
  std::vector<std::vector<std::pair<std::uint32_t, double>>> means_;
  std::size_t channel_ = 0;  // That is being solved or bounded.
  std::optional<ResidualMinimiser> minimiser_;
  std::optional<LightMajorant> majorant_;
  std::vector<GlossyLight> lights_;         // By channel.
  std::vector<Values> values_;              // By channel, at the Gauss points.
  std::vector<double> brightest_;           // By channel.
  std::vector<Values> residual_values_;     // By channel, at all points that are checked.
  std::vector<std::size_t> first_checked_;  // By cell: the first of these.
  std::vector<GlossyLight> residuals_;      // By channel.
  std::vector<Values> largest_, missed_;    // Of the residual, by channel, then cell.
  std::vector<Off> off_;                    // By cell.
  std::vector<Values> spread_;              // By channel, then cell: the most of |T r|.
  std::vector<Values> bounds_;              // By channel, then cell.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_RADIOSITY_H_
