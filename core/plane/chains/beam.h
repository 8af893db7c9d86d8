// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_CHAINS_BEAM_H_
#define FLATLIGHT_CORE_PLANE_CHAINS_BEAM_H_

#include <cstddef>
#include <memory>

#include "core/plane/chains/chain.h"
#include "core/plane/chains/line_family.h"

namespace flatlight {

// Light behind a chain, by way of a stretch of its first link. Single rays may be blocked on the way.
struct Beam {
  std::shared_ptr<const Chain> chain;
  LineFamily lines;  // Over the fraction of the first link's length.
  double flux = 0;   // About; in the strongest channel. Positive.

  std::size_t links() const { return chain->links.size(); }
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_CHAINS_BEAM_H_
