// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_KRYLOV_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_KRYLOV_H_

#include <functional>
#include <vector>

namespace flatlight {

using LinearMap = std::function<void(const std::vector<double>& in, std::vector<double>& out)>;

// Solves map(x) = right by the method of generalised minimal residuals (Saad and Schultz 1986), from x on, until the
// residual's norm is below `tolerance` times that of `right` or no longer falls, or `stop` asks for an end. Sums run in
// a fixed order.
void SolveByResiduals(const LinearMap& map, const std::vector<double>& right, double tolerance,
                      const std::function<bool()>& stop, std::vector<double>& x);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_KRYLOV_H_
