// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_RADIOSITY_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_RADIOSITY_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/math/tolerances.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/accumulation.h"
#include "core/plane/reference/error_growth.h"
#include "core/plane/reference/majorant.h"
#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/reception.h"
#include "core/plane/reference/row.h"
#include "core/plane/reference/visibility_events.h"

namespace flatlight {

// The light that leaves the panels of a mesh by reflection, L = rho/2 (E_direct + T L): a polynomial on each, right at
// its Gauss points; and bounds on its error, from what it leaves over between them (THEORY 18 B7, B8).
//
// With the residual r = b + T L - L of a computed L the error is e = r + T e. So e = r + e1 with e1 = T r + T e1, and
// |e1| is at most the solution of w = |T r| + T w, for T keeps what is positive so. T r is small, for r has all but no
// mean on a panel; so the bound stays sharp where curves reflect nearly all. Of all bounces, what is known of T r with
// its sign is light: e1 is solved for and added, and only what r's polynomial misses is left to be bounded.
//
// Steps, in this order: BuildRows of all panels, Solve, Check of all panels, Spread of all panels, Correct, Bound.
// Steps of panels may run at once on several threads; Solve, Correct and Bound are called until they return true, which
// may stop and go on between calls. Equal bits for any number of threads.
class Radiosity {
 public:
  // Runs work(0) ... work(count - 1).
  using Loop = std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

  // Requires CanFollow(scene), and max_bounces != 0 (absent: all), if there are panels. Only the
  // first `channels` are computed. The caster, the charts and the events must outlive this.
  // `tolerance`: to which the equations at the nodes are solved, of their right sides; what is left over is part of the
  // bound. Rows of the mesh that this one was made of save most of the work for new ones, and its light is the guess
  // from which to solve.
  struct Rows {
    std::vector<Row> nodes;    // By panel, then node.
    std::vector<Row> between;  // By panel, then point between nodes.
    std::vector<std::vector<Row>> cells;
  };
  Radiosity(const RayCaster& caster, const std::vector<Chart>& charts, const Events& events, PanelMesh mesh,
            std::size_t channels, std::optional<std::uint32_t> max_bounces, double tolerance,
            Radiosity* before = nullptr);

  const PanelMesh& mesh() const { return mesh_; }
  // In bytes, of the rows built so far; and of the rest, per panel and about.
  std::size_t memory() const;
  static constexpr std::size_t kPanelBytes = 3000;
  // Frees the rows: what follows from the light and its errors stays, finer meshes have rows of their own.
  void DropRows();

  // In parts, of which each may run by itself.
  static constexpr std::size_t kRowParts = 2 * kLightCoefficients + 1;
  void BuildRows(RowBuilder& builder, std::size_t panel, std::size_t part);
  bool Solve(const Loop& loop);
  void Check(std::size_t panel);
  void Spread(std::size_t panel);
  bool Correct(const Loop& loop);
  bool Bound(const Loop& loop);

  // Right at nodes but for T of errors().residual; with that it is right elsewhere, too.
  const PanelLight& light() const { return light_; }
  const LightErrors& errors() const { return errors_; }
  LightErrors& errors() { return errors_; }
  // What lies between events on a panel, if it has any.
  const std::vector<Cell>& CellsOf(std::size_t panel) const { return cells_[panel]; }
  // How much of all that Bound() starts from comes of what ways over mirrors and glass that were not followed further
  // could have brought: a part of 1.
  double UnfollowedPart(std::size_t channel) const;
  // What the residual of each panel adds to something by way of other panels' bounds, about, where a bound on any panel
  // adds so much.
  std::vector<double> Influence(std::vector<double> importance) const;

 private:
  using Values = std::vector<double>;  // By panel, then node.
  static constexpr std::size_t kNodes = kLightCoefficients;
  // Above this the largest bounds of all panels would add up to far more than there is.
  static constexpr double kReflectsMuch = 0.8;
  // Of a row's sum, in units of roundoff.
  static constexpr double kRounding = 16 * kUnitRoundoff;

  double HalfReflectance(std::size_t panel, std::size_t channel) const;
  void ToCoefficients(const Values& values, Values& coefficients) const;
  // By arc length, of integrals over the panels.
  Values NodeWeights() const;
  // Of a row and its panels, by nodes: integrals over the panels of functions with these values, all but exact where
  // the panel is seen as a whole, and none of them below 0.
  void FindPositive(std::size_t row);
  void TransportPositive(const Loop& loop, std::size_t channel, const Values& values, Values& out) const;
  // T of a light.
  void Transport(const Loop& loop, std::size_t channel, const Values& coefficients, Values& out) const;
  double MostReflected(std::size_t panel, const Row& row, std::size_t entry) const;
  // To what a panel's light matters straight away, what it matters by way of others.
  void AddByWayOfOthers(std::vector<double>& importance) const;
  // One step of what comes of a source in the channel that is being worked on.
  bool Accumulate(const Loop& loop, const std::function<Values()>& source, const Values& start, double tolerance);
  // The light of a channel at the nodes of another mesh.
  Values OnNodesOf(const PanelMesh& mesh, std::size_t channel) const;
  void CheckCells(std::size_t panel, std::size_t channel);
  void CheckAt(std::size_t panel, const Row& row, const double* p, std::size_t channel, double& residual,
               double& rounding) const;
  double UnfollowedAt(std::size_t panel, const Row& row, std::size_t channel) const {
    return HalfReflectance(panel, channel) * row.lost * errors_.brightest.value[channel];
  }

  const Scene& scene_;
  const std::vector<Chart>& charts_;
  const Events& events_;
  PanelMesh mesh_;
  std::vector<std::vector<Cell>> cells_;  // By panel.
  std::size_t channels_;
  std::optional<std::uint32_t> max_bounces_;
  Values to_coefficients_, to_residual_;  // Matrices.
  double tolerance_;
  Rows rows_, rows_before_;
  std::vector<Values> start_;  // By channel: a guess at the light at the nodes.
  std::size_t channel_ = 0;    // That is being solved or bounded.
  std::optional<Accumulation> accumulation_;
  std::optional<ErrorGrowth> growth_;
  std::optional<Majorant> majorant_;
  Values brightest_;                   // By panel, then channel: the largest radiance at nodes.
  PanelLight light_, first_, before_;  // Of all bounces, of one, of one less than all.
  PanelLight first_residual_;
  LightErrors errors_;
  Values rounding_;                           // By panel, then channel.
  Values unfollowed_;                         // The same; the part that comes of ways not followed further.
  Values spread_;                             // By panel, node, channel: bounds on what of |T r| is not light by now,
  Values correction_;                         // and what is known of T r.
  std::vector<std::vector<float>> positive_;  // By panel, node; where bounds need them.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_RADIOSITY_H_
