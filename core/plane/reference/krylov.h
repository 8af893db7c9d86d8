// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_KRYLOV_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_KRYLOV_H_

#include <functional>
#include <vector>

namespace flatlight {

using LinearMap = std::function<void(const std::vector<double>& in, std::vector<double>& out)>;

// Solves map(x) = right by the method of generalised minimal residuals (Saad and Schultz 1986), from `start` on, until
// the residual's norm is below `tolerance` times that of `right` or no longer falls. It goes step by step, so that who
// calls may stop between two of them and go on later. Sums run in a fixed order. `weights`: positive, of the squares in
// norms; empty: 1.
class ResidualMinimiser {
 public:
  ResidualMinimiser(std::vector<double> right, std::vector<double> start, double tolerance,
                    std::vector<double> weights = {});

  // Applies the map once. Returns whether the solution is there.
  bool Step(const LinearMap& map);
  // Requires that a step returned true.
  const std::vector<double>& solution() const { return x_; }

 private:
  using Vector = std::vector<double>;

  double Product(const Vector& a, const Vector& b) const;
  bool BeginCycle(const LinearMap& map);
  void EndCycle();

  Vector right_, x_, weights_;
  double goal_;
  int cycles_ = 0;
  double norm_before_ = 0;
  // Of the cycle: an orthonormal basis, empty between two cycles, the map in it as a triangle, and the rotations that
  // made it one.
  std::vector<Vector> basis_, columns_;
  Vector cosine_, sine_, reduced_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_KRYLOV_H_
