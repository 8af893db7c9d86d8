// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_JOB_FORMAT_H_
#define FLATLIGHT_SERVER_SERVICE_JOB_FORMAT_H_

#include <string>
#include <utility>

#include "server/store/durable_job_store.h"
#include "server/store/retention.h"

namespace flatlight {

// Jobs are written as what callers see of them: Job and RenderResult, serialised.
class ProtoJobFormat final : public JobFormat {
 public:
  ProtoJobFormat(std::string build, const Retention& retention) : build_(std::move(build)), retention_(retention) {}

  std::string WriteMessage(const JobRecord& job) const override;
  std::optional<std::string> WriteResult(const JobRecord& job) const override;
  std::string WriteEvent(const JobRecord& job) const override;
  absl::StatusOr<JobRecord> Read(const ArchivedJob& job, const std::string* result) const override;

 private:
  const std::string build_;
  const Retention retention_;  // As of now: when a job expires is not what was written, but follows from its end.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_JOB_FORMAT_H_
