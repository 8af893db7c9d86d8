// SPDX-License-Identifier: Apache-2.0
#include "server/service/quota_calls.h"

#include <algorithm>
#include <chrono>

namespace flatlight {
namespace {

template <class Limit>
void Fill(double used, const Limit& limit, v1::Quota& quota) {
  quota.set_used(used);
  if (limit) quota.set_limit(static_cast<double>(*limit));
}

}  // namespace

std::uint64_t StorageOf(Backend& backend, const std::string& user) {
  return backend.scenes.BytesOf(user) + backend.jobs.StoredBytesOf(user);
}

void FillQuotas(Backend& backend, const Caller& caller, v1::Quotas& all) {
  const Quotas& quotas = backend.guard.QuotasOf(caller.role);
  all.set_user(caller.name);
  all.set_role(std::string(RoleName(caller.role)));
  Fill(static_cast<double>(backend.scheduler.JobsOf(caller.name)), quotas.jobs, *all.mutable_jobs());
  Fill(backend.ledger.UsedToday(caller.name), quotas.cpu_seconds, *all.mutable_cpu_seconds());
  all.set_day_ends_in(std::chrono::duration<double>(backend.ledger.UntilTomorrow()).count());
  Fill(static_cast<double>(backend.hub.SizeOf(caller.name)), quotas.watches, *all.mutable_watches());
  Fill(static_cast<double>(StorageOf(backend, caller.name)), quotas.storage_bytes, *all.mutable_storage_bytes());
  all.mutable_requests()->set_used(backend.guard.RequestsTaken(caller));
  if (quotas.requests) {
    all.mutable_requests()->set_limit(RequestsAtOnce(*quotas.requests));
    all.set_requests_per_second(*quotas.requests);
  }
}

}  // namespace flatlight
