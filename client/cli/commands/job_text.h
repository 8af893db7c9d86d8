// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_COMMANDS_JOB_TEXT_H_
#define FLATLIGHT_CLIENT_CLI_COMMANDS_JOB_TEXT_H_

#include <string>
#include <vector>

#include "client/cli/jobs/job_name.h"
#include "flatlight/v1/render_service.pb.h"

namespace flatlight {

// A line a job under a heading. `now` in seconds since 1970.
std::string JobListText(const std::vector<v1::Job>& jobs, double now, WhoseJobs whose);

// All about a job.
std::string JobText(const v1::Job& job);
// "group:lab-1 (read), user:ada (control)", or "nobody".
std::string SharesText(const google::protobuf::RepeatedPtrField<v1::Share>& shares);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_COMMANDS_JOB_TEXT_H_
