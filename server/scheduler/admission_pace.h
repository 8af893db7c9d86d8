// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_ADMISSION_PACE_H_
#define FLATLIGHT_SERVER_SCHEDULER_ADMISSION_PACE_H_

#include <cstddef>
#include <optional>

#include "core/execution/clock.h"

namespace flatlight {

// How often, of late, a job that waited has been given a place.
class AdmissionPace {
 public:
  void NoteWaiting(Clock::Time now) {
    if (!since_) since_ = now;
  }
  void NoteNobodyWaits() { since_.reset(); }
  // A job that waited has been given a place.
  void NoteAdmission(Clock::Time now) {
    if (!since_) return;
    const Clock::Duration interval = now - *since_;
    mean_ = mean_ ? *mean_ + (interval - *mean_) / kMemory : interval;
    since_ = now;
  }

  // Until a job with so many ahead of it has its place; nothing before the first has been given.
  std::optional<Clock::Duration> Wait(std::size_t ahead) const {
    if (!mean_) return std::nullopt;
    return *mean_ * (ahead + 1);
  }

 private:
  static constexpr int kMemory = 8;   // Admissions.
  std::optional<Clock::Time> since_;  // The last admission, or since somebody waits.
  std::optional<Clock::Duration> mean_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_ADMISSION_PACE_H_
