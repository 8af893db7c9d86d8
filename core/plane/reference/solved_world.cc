// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/solved_world.h"

namespace flatlight {

std::size_t SolvedWorld::bytes() const {
  std::size_t bytes = sizeof(SolvedWorld) + charts.size() * sizeof(Chart);
  for (const Events* all : {&events, &kinks})
    for (const std::vector<Event>& on_side : *all) bytes += sizeof(std::vector<Event>) + on_side.size() * sizeof(Event);
  return bytes + (radiosity ? radiosity->memory() + radiosity->mesh().size() * Radiosity::kPanelBytes : 0);
}

}  // namespace flatlight
