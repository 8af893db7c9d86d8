// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_SCHEDULER_EVENTS_H_
#define FLATLIGHT_SERVER_SCHEDULER_SCHEDULER_EVENTS_H_

#include <cstddef>
#include <map>
#include <string>

#include "core/execution/clock.h"
#include "server/store/job.h"

namespace flatlight {

// What a scheduler tells of its work to whoever measures it. Told from any thread, with the scheduler's lock held: to
// be quick, and to call nothing of the scheduler.
class SchedulerEvents {
 public:
  virtual ~SchedulerEvents() = default;

  // A job got a place, after so long (pauses left out).
  virtual void Admitted(const JobSpec& spec, Clock::Duration waited) = 0;
  // Its first picture, so long after it was made or restored (pauses left out).
  virtual void FirstPicture(const JobSpec& spec, Clock::Duration since_entry) = 0;
  // A slice has cost this much, in preparation or rendering, and traced so many rays.
  virtual void Worked(const JobSpec& spec, double rays, double cpu_seconds) = 0;
  // All work for a job ended so long after that was wished.
  virtual void Cancelled(const JobSpec& spec, Clock::Duration latency) = 0;
  virtual void Ended(const JobSpec& spec, const JobState& state) = 0;
};

// What there is to do, at one moment.
struct SchedulerLoad {
  struct User {
    std::size_t waiting = 0;
    std::size_t running = 0;
    std::size_t paused = 0;
    double cpu_seconds = 0;  // Of those jobs, so far.
  };
  std::map<std::string, User> users;  // Who have jobs that have not ended.

  User Total() const {
    User total;
    for (const auto& [name, user] : users) {
      total.waiting += user.waiting;
      total.running += user.running;
      total.paused += user.paused;
      total.cpu_seconds += user.cpu_seconds;
    }
    return total;
  }
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_SCHEDULER_EVENTS_H_
