// SPDX-License-Identifier: Apache-2.0
// Laws that all of transport must obey, through the door of core/render.
#ifndef FLATLIGHT_TESTS_BENCH_STRESS_PHYSICS_H_
#define FLATLIGHT_TESTS_BENCH_STRESS_PHYSICS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/stress/checks.h"

namespace flatlight::stress {

struct PhysicsCheck {
  std::string name;
  Failure (*run)(std::uint64_t seed);
};

const std::vector<PhysicsCheck>& PhysicsChecks();

}  // namespace flatlight::stress

#endif  // FLATLIGHT_TESTS_BENCH_STRESS_PHYSICS_H_
