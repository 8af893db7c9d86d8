// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_KNOWN_RECORDS_H_
#define FLATLIGHT_SERVER_SERVICE_KNOWN_RECORDS_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/render/plan.h"
#include "flatlight/v1/render_service.pb.h"
#include "server/service/job_access.h"
#include "server/service/policy.h"

namespace flatlight {

struct TakenRecords {
  std::shared_ptr<const std::vector<RecordField>> records;
  std::string checksum;
};

// The records of the job that a request names, with their seal; a job that the caller may not see is not known.
absl::StatusOr<v1::KnownRecords> RecordsOfJob(const Caller& caller, const v1::KnownRecords& known,
                                              const JobAccess& jobs);

// The records that a request brings for a plan. An error if they are damaged, or are of another world or gather than
// the plan's.
absl::StatusOr<TakenRecords> TakeRecords(const v1::KnownRecords& known, const Scene& scene, const Plan& plan);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_KNOWN_RECORDS_H_
