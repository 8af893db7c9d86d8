// SPDX-License-Identifier: Apache-2.0
// What a place of a panel sends into a number of directions: rows of the discrete transport operator.
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_SCATTER_ROW_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_SCATTER_ROW_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/plane/glossy/cell_mesh.h"
#include "core/plane/glossy/incoming.h"
#include "core/scene/spectrum.h"

namespace flatlight {

struct ScatterRow {
  struct Seen {
    std::uint32_t cell = 0;
    double x = 0, y = 0;  // In it.
  };
  // Of a direction: weights of some rays in a row; those of all others are 0.
  struct Band {
    std::size_t begin = 0;  // In `weights`.
    std::size_t ray = 0;    // The first.
    std::size_t count = 0;
  };

  std::vector<Seen> rays;  // That come from panels.
  std::vector<Band> bands;
  std::vector<double> weights;
  // Radiance by direction, over reflectance, that comes straight from what emits.
  std::vector<Spectrum> source;

  // Of light on those rays.
  double Scatter(std::size_t direction, const double* light) const {
    const Band& band = bands[direction];
    const double *const w = weights.data() + band.begin, *const l = light + band.ray;
    // Sums that do not wait for one another.
    double sums[4] = {};
    std::size_t i = 0;
    for (; i + 4 <= band.count; i += 4)
      for (std::size_t k = 0; k < 4; ++k) sums[k] += w[i + k] * l[i + k];
    for (; i < band.count; ++i) sums[0] += w[i] * l[i];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }
  std::size_t bytes() const {
    return rays.size() * sizeof(Seen) + bands.size() * (sizeof(Band) + sizeof(Spectrum)) +
           weights.size() * sizeof(double);
  }
};

// Holds working memory: one for each thread.
class ScatterRowBuilder {
 public:
  // As Incoming.
  ScatterRowBuilder(const RayCaster& caster, const std::vector<Chart>& charts, int digits)
      : charts_(charts), incoming_(caster, charts, digits) {}

  // From place x in [-1, 1] of a panel, in directions by their half tangents; Lambertian panels have one, whichever.
  void Build(const CellMesh& mesh, std::size_t panel, double x, const std::vector<double>& directions, ScatterRow& row);

 private:
  void AddLobe(const GlossyLobe& lobe, LocalDirection out, ScatterRow& row);
  // Weights of a stretch that the lobe ends in.
  void AddCut(const GlossyLobe& lobe, LocalDirection out, const IncomingStretch& stretch);

  const std::vector<Chart>& charts_;
  Incoming incoming_;
  std::vector<double> weights_;  // By ray, of one direction.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_SCATTER_ROW_H_
