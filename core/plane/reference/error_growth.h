// SPDX-License-Identifier: Apache-2.0
// How an error of light grows by being reflected.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_ERROR_GROWTH_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_ERROR_GROWTH_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/plane/reference/krylov.h"
#include "core/plane/reference/row.h"

namespace flatlight {

// Bounds, one for each panel, on what sources of error at its nodes come to after all bounces: the least w with
// w >= s + rho/2 (irradiance at the node from panels of radiance w) at each node. A guess comes from the equation at
// the node of each panel where most is wanted; what it lacks at any other is a known part of s there, and by that part
// all of w is raised. So it is a bound however well the equations were solved.
class ErrorGrowth {
 public:
  // Runs work(0) ... work(count - 1).
  using Loop = std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

  // `rows` and `source` by panel, then node; rho/2 by panel. The rows must outlive this.
  ErrorGrowth(const std::vector<Row>& rows, std::size_t channel, std::vector<double> source,
              std::vector<double> half_reflectance, std::optional<std::uint32_t> bounces);

  // Goes step by step; returns whether the bounds are there.
  bool Step(const Loop& loop);
  // Requires that a step returned true.
  const std::vector<double>& bounds() const { return bounds_; }

 private:
  // The equation of a panel at one of its nodes.
  struct Equation {
    double source = 0;
    double wanted = 0;  // Of the panel, by the bounds that there are.
    double lack = 0;    // The largest part of the source that the bound lacks at any node.
    std::vector<std::uint32_t> panels;
    std::vector<double> shares;
  };
  void Look(std::size_t panel);
  bool Raise();

  const std::vector<Row>& rows_;
  std::size_t channel_;
  std::vector<double> source_, half_;
  std::uint32_t bounces_ = 0;  // Still to come.
  bool all_bounces_;
  int looks_ = 0;
  std::vector<double> bounds_;
  std::vector<Equation> equations_;
  std::optional<ResidualMinimiser> minimiser_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_ERROR_GROWTH_H_
