// SPDX-License-Identifier: Apache-2.0
// Derivatives along the receiver of irradiance over mirrors and through glass: the quadrature in angle of
// SpecularGather, whose points move with the ends of what is seen.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_DERIVATIVES_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_DERIVATIVES_H_

#include <array>
#include <cstddef>
#include <vector>

#include "core/plane/chains/beam_cuts.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/moving_ways.h"
#include "core/plane/reference/panel_light.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/specular_view.h"
#include "core/scene/scene.h"

namespace flatlight {

// Of one receiver, which must outlive it, as the scene and the charts must.
class SpecularDerivatives {
 public:
  // `tolerance`: of irradiance per radiance, over the whole half circle. `derivatives`: 1 or 2.
  SpecularDerivatives(const Scene& scene, const std::vector<Chart>& charts, const Receiver& receiver, double tolerance,
                      int derivatives)
      : scene_(scene),
        charts_(charts),
        ways_(scene, receiver),
        tolerance_(tolerance),
        orders_(static_cast<std::size_t>(derivatives) + 1) {}

  // Of irradiance from Legendre polynomials on a panel, or from radiance 1, in a part of a piece, but for the tint; by
  // the order of the derivative.
  struct Moments {
    std::array<std::array<double, kResidualCoefficients>, 3> value{};
    std::array<double, 3> error{};  // Of any of them, about.
    // What the light's value is weighed with, its slope and its second derivative by the panel's place in [-1, 1]:
    // sums of what is positive and negative alike. So an error of light goes to derivatives.
    std::array<double, 3> of_value{}, of_slope{}, of_bend{};
    bool known = true;  // If not, ends of the part move in a way that could not be told.

    // What the derivative of an order may be off by for light that is off by 1, with such slopes and second
    // derivatives.
    double OfLight(std::size_t order, double slope, double bend) const {
      return of_value[order] + slope * of_slope[order] + bend * of_bend[order];
    }
  };

  // From radiance 1: value[.][0].
  Moments OfPiece(const SpecularPiece& piece);
  // Between two numbers of the piece; what has no mark is an end of it.
  Moments OfPanel(const SpecularPiece& piece, const Panel& panel, std::size_t count, const Cuts::Cut& begin,
                  const Cuts::Cut& end);
  // What could have come that way, if it moves as its ends do: of_value.
  Moments OfUnfollowed(const UnfollowedBeam& beam);

 private:
  // From radiance 1 between two directions.
  Moments OfSines(const Directions& directions, const Motion& from, const Motion& to);
  Moments Of(const SpecularPiece& piece, const Panel* panel, std::size_t count, const Motion& from, const Motion& to);
  // Adds a point of the quadrature: of directions by a number in [0, 1] of the part. Returns false where a ray fails.
  bool AddPoint(const SpecularPiece& piece, const Panel* panel, std::size_t count, const Directions& part,
                const Motion& from, const Motion& to, double x, double weight, Moments& sum);

  const Scene& scene_;
  const std::vector<Chart>& charts_;
  MovingWays ways_;
  double tolerance_;
  std::size_t orders_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_SPECULAR_DERIVATIVES_H_
