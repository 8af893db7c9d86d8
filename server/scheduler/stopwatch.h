// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_STOPWATCH_H_
#define FLATLIGHT_SERVER_SCHEDULER_STOPWATCH_H_

#include <optional>

#include "core/execution/clock.h"

namespace flatlight {

// A clock that can stand still: a job's time limit and its elapsed time do not count the hours in which it was paused.
class Stopwatch final : public Clock {
 public:
  // `clock` must outlive this.
  explicit Stopwatch(const Clock& clock) : clock_(clock) {}

  Time Now() const override { return (stopped_ ? *stopped_ : clock_.Now()) - stood_still_; }
  void Stop() {
    if (!stopped_) stopped_ = clock_.Now();
  }
  void Continue() {
    if (stopped_) stood_still_ += clock_.Now() - *stopped_;
    stopped_.reset();
  }

 private:
  const Clock& clock_;
  std::optional<Time> stopped_;
  Duration stood_still_{0};
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_STOPWATCH_H_
