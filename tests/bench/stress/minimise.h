// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_MINIMISE_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_MINIMISE_H_

#include <functional>

#include "core/scene/description.h"

namespace flatlight::stress {

// A scene with as little in it as can be found for which `fails` is still true: curves, probes and vertices are
// dropped, arcs become segments, emission and reflection go, numbers get fewer digits. Calls `fails` at most
// `most_calls` times.
SceneDescription Minimised(SceneDescription scene, const std::function<bool(const SceneDescription&)>& fails,
                           int most_calls = 800);

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_MINIMISE_H_
