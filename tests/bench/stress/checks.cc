// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/checks.h"

namespace flatlight::stress {

const std::vector<Check>& Checks() {
  static const auto& checks = *new std::vector<Check>{
      {"builds", CheckBuilds, 1, Crowding::kThousands},
      {"finite", CheckFinite, 1, Crowding::kHundreds},
      {"tree", CheckTree, 1, Crowding::kThousands},
      {"closed", CheckClosed, 1},
      {"rays", CheckAgainstRays, 1},
      {"oracle", CheckAgainstOracle, 40},
      {"triangles", CheckTriangles, 1, Crowding::kHundreds},
      {"sampling", CheckSampling, 2, Crowding::kHundreds},
      {"visibility skip", CheckVisibilitySkip, 1},
      {"powers of two", CheckPowersOfTwo, 4, Crowding::kHundreds},
      {"grid moves", CheckGridMoves, 1},
      {"similarity", CheckSimilarity, 2},
      {"order", CheckOrder, 2, Crowding::kHundreds},
      {"reversal", CheckReversal, 2, Crowding::kHundreds},
      {"linearity", CheckLinearity, 4},
  };
  return checks;
}

}  // namespace flatlight::stress
