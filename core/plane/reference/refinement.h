// SPDX-License-Identifier: Apache-2.0
// Which panels to split, and where.
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_REFINEMENT_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_REFINEMENT_H_

#include <vector>

#include "core/plane/reference/panel_mesh.h"
#include "core/plane/reference/visibility_events.h"

namespace flatlight {

// Marks the panels that matter: what the others add to the error, `shares`, is together at most a part of what is
// allowed, 1, or of what there is.
std::vector<char> PanelsToSplit(const std::vector<double>& shares);

// Where to split a panel, in its chart and in their order: at events, where light is off most between them (`cells`),
// if it has any; else near an end where another curve meets it (`meetings` of its element), else at the strongest kink
// (`kinks` of its side, in order), which no polynomial follows, else in the middle. Empty if it is too short to be
// split.
std::vector<double> SplitPlaces(const Panel& panel, const std::vector<Cell>& cells, const std::vector<double>& meetings,
                                const std::vector<Event>& kinks);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_REFINEMENT_H_
