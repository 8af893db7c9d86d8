// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SCHEDULER_JOB_CHECKPOINT_H_
#define FLATLIGHT_SERVER_SCHEDULER_JOB_CHECKPOINT_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace flatlight {

// A rendering's checkpoint, and what the scheduler knows beside it.
struct JobCheckpoint {
  std::string job_key;  // Of the job that it belongs to: scene, settings and build.
  double elapsed_seconds = 0;
  double cpu_seconds = 0;
  std::int64_t start_time = 0;  // ns since 1970.
  std::string rendering;
};

std::string WriteJobCheckpoint(const JobCheckpoint& checkpoint);
// Nothing if the bytes are of another form.
std::optional<JobCheckpoint> ReadJobCheckpoint(std::string_view bytes);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SCHEDULER_JOB_CHECKPOINT_H_
