// SPDX-License-Identifier: Apache-2.0
#include "core/plane/materials/fresnel.h"

#include <cmath>

namespace flatlight {

FresnelSplit SplitAtBorder(LocalDirection in, double ratio) {
  const double sine = in.sine / ratio;
  const double square = (1 - sine) * (1 + sine);
  if (!(square > 0)) return {};
  const double cosine = std::sqrt(square);
  const double parallel = (ratio * in.cosine - cosine) / (ratio * in.cosine + cosine);
  const double perpendicular = (in.cosine - ratio * cosine) / (in.cosine + ratio * cosine);
  FresnelSplit split;
  split.reflected = 0.5 * (parallel * parallel + perpendicular * perpendicular);
  // The far side lies behind: light that comes along +tangent goes on along -tangent, seen from the border.
  split.transmitted = {-sine, -cosine};
  return split;
}

}  // namespace flatlight
