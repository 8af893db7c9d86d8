// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_JOB_FORMAT_H_
#define FLATLIGHT_SERVER_STORE_JOB_FORMAT_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "server/store/job.h"

namespace flatlight {

struct ArchivedJob;

// What jobs look like when they are written. The result of a job that has no field is nothing.
class JobFormat {
 public:
  virtual ~JobFormat() = default;
  virtual std::string WriteMessage(const JobRecord& job) const = 0;
  virtual std::optional<std::string> WriteResult(const JobRecord& job) const = 0;
  // What a job's webhook is told of its end.
  virtual std::string WriteEvent(const JobRecord& job) const = 0;
  // Without a result: without a field, and without the probes of its scene.
  virtual absl::StatusOr<JobRecord> Read(const ArchivedJob& job, const std::string* result) const = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_JOB_FORMAT_H_
