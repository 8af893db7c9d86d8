// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_LIGHT_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_LIGHT_H_

#include <cstddef>
#include <vector>

#include "core/plane/glossy/cell_mesh.h"

namespace flatlight {

// Radiance in one channel: on each cell a sum of products of Legendre polynomials of place and direction.
class GlossyLight {
 public:
  // `values`: cell by cell, at the places and directions where both numbers are among `points`, by place, then
  // direction; those of Lambertian panels have one direction. The mesh must outlive this.
  GlossyLight(const CellMesh& mesh, const std::vector<double>& points, const std::vector<double>& values);

  // At a place of a cell, both numbers in [-1, 1].
  double At(std::size_t cell, double x, double y) const;
  // What is left of a cell's sums where the last two coefficients of either number are the largest: how far the sum
  // may be off between the points if it has not become small there.
  double Last(std::size_t cell) const;

 private:
  const CellMesh& mesh_;
  std::size_t count_;
  std::vector<std::size_t> first_;  // By cell, in:
  std::vector<double> coefficients_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_LIGHT_H_
