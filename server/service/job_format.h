// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_JOB_FORMAT_H_
#define FLATLIGHT_SERVER_SERVICE_JOB_FORMAT_H_

#include <string>
#include <utility>

#include "server/store/durable_job_store.h"

namespace flatlight {

// Jobs are written as what callers see of them: Job and RenderResult, serialised.
class ProtoJobFormat final : public JobFormat {
 public:
  explicit ProtoJobFormat(std::string build) : build_(std::move(build)) {}

  std::string WriteMessage(const JobRecord& job) const override;
  std::optional<std::string> WriteResult(const JobRecord& job) const override;
  std::string WriteEvent(const JobRecord& job) const override;
  absl::StatusOr<JobRecord> Read(const ArchivedJob& job, const std::string* result) const override;

 private:
  const std::string build_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_JOB_FORMAT_H_
