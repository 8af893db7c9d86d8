// SPDX-License-Identifier: Apache-2.0
#include "server/store/job_id.h"

#include "server/store/uuid.h"

namespace flatlight {
namespace {

constexpr std::string_view kPrefix = "jobs/";

}  // namespace

JobId JobId::Random() {
  JobId id;
  id.uuid_ = RandomUuid();
  return id;
}

std::optional<JobId> JobId::FromName(std::string_view name) {
  if (!name.starts_with(kPrefix) || !IsUuid(name.substr(kPrefix.size()))) return std::nullopt;
  JobId id;
  id.uuid_ = name.substr(kPrefix.size());
  return id;
}

}  // namespace flatlight
