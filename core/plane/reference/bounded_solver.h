// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_BOUNDED_SOLVER_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_BOUNDED_SOLVER_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/plane/exact/exact.h"
#include "core/plane/reference/solved_world.h"

namespace flatlight {

// Light at the points of a scene's probes with bounds on its error, which become smaller round after round.
class BoundedSolver {
 public:
  virtual ~BoundedSolver() = default;

  // Works for about `budget`, until done or cancelled. For equal rounds done the values have equal bits.
  virtual void Advance(Executor& executor, int threads, const Cancellation& cancellation, const Clock& clock,
                       Clock::Duration budget) = 0;
  enum class State : std::uint8_t {
    kWorks,
    kReached,   // The bounds are as small as wanted.
    kExhausted  // Rounding, or the memory that is allowed, lets them become no smaller.
  };
  virtual State state() const = 0;

  // By point, after the last round that was finished; empty before the first was.
  virtual const std::vector<ExactValue>& values() const = 0;
  // By point, before the first round is done: direct light as far as it is known, and bounds on all light.
  virtual std::vector<ExactValue> FirstValues() const = 0;
  // The largest bound in units of max(irradiance, 1 % of its probe's mean), and after the first round.
  virtual double relative_error() const = 0;
  virtual double first_relative_error() const = 0;
  virtual int rounds() const = 0;
  // What it knows of the world, for solvers to come; null: nothing that these can use. Requires kReached; but for
  // values() and errors nothing is to be called afterwards.
  virtual std::unique_ptr<SolvedWorld> TakeWorld() = 0;

 protected:
  // Of what errors are relative to, and of the probe's mean.
  static constexpr double kFloor = 0.01;
  static double Relative(double error, double size) {
    return error == 0 ? 0 : size > 0 ? error / size : std::numeric_limits<double>::infinity();
  }
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_BOUNDED_SOLVER_H_
