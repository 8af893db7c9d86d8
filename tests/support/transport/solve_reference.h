// SPDX-License-Identifier: Apache-2.0
// Whole reference solutions in one call.
#ifndef FLATLIGHT_TESTS_SUPPORT_TRANSPORT_SOLVE_REFERENCE_H_
#define FLATLIGHT_TESTS_SUPPORT_TRANSPORT_SOLVE_REFERENCE_H_

#include <memory>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/reference_solver.h"

namespace flatlight {

struct SolvedReference {
  std::vector<ExactValue> values;  // By point, in units of the world whose radiance and length are 1.
  ReferenceSolver::State state = ReferenceSolver::State::kWorks;
  double relative_error = 0;
  int rounds = 0;
};

// Grey scenes: one channel is computed.
inline SolvedReference SolveReference(const std::shared_ptr<const Scene>& scene, const ReferenceOptions& options,
                                      int threads = 1) {
  ThreadPool pool(threads);
  ReferenceSolver solver(scene, std::make_shared<const RayCaster>(scene), options);
  const SteadyClock clock;
  const Cancellation never;
  while (solver.state() == ReferenceSolver::State::kWorks)
    solver.Advance(pool, threads, never, clock, Clock::Duration::max());
  SolvedReference solved = {solver.values(), solver.state(), solver.relative_error(), solver.rounds()};
  const double radiance = scene->frame().radiance_scale, scale = scene->frame().scale;
  for (ExactValue& value : solved.values) {
    for (Spectrum* s : {&value.irradiance, &value.irradiance_error}) *s = radiance * *s;
    for (Spectrum* s : {&value.gradient, &value.gradient_error}) *s = (radiance / scale) * *s;
    for (Spectrum* s : {&value.hessian, &value.hessian_error}) *s = (radiance / scale / scale) * *s;
  }
  return solved;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_SUPPORT_TRANSPORT_SOLVE_REFERENCE_H_
