// SPDX-License-Identifier: Apache-2.0
#include "server/service/known_records.h"

#include <utility>

#include "server/convert/record_convert.h"
#include "server/convert/settings_convert.h"
#include "server/service/job_convert.h"
#include "server/service/status_convert.h"
#include "server/store/error.h"

namespace flatlight {
namespace {

absl::Status Refuse(const std::string& path, const std::string& message) {
  Diagnostics diagnostics;
  diagnostics.Add(path, message);
  return MakeDiagnosticsError("BAD_RECORDS", "the records", diagnostics);
}

}  // namespace

absl::StatusOr<v1::KnownRecords> RecordsOfJob(const Caller& caller, const v1::KnownRecords& known,
                                              const JobAccess& jobs) {
  if (known.records_size() > 0 || known.has_seal())
    return Refuse("records.job", "is given together with records: leave one of them out");
  const auto id = ParseJobName(known.job());
  if (!id.ok()) return Refuse("records.job", "\"" + known.job() + "\"; a job is named jobs/{uuid}");
  const auto job = jobs.FindSeen(caller, *id);
  if (!job.ok()) return Refuse("records.job", "\"" + known.job() + "\" is not known here");
  if (!HasEnded(job->state->phase)) return Refuse("records.job", "has not ended; watch it until it has, or cancel it");
  const auto& field = job->state->field;
  if (field == nullptr || field->records.empty()) return Refuse("records.job", "has made no records");
  v1::KnownRecords records;
  FillRecords(field->records, *records.mutable_records());
  *records.mutable_seal() = SealOf(job->spec->scene->world_hash, job->spec->plan.settings, records.records());
  return records;
}

absl::StatusOr<TakenRecords> TakeRecords(const v1::KnownRecords& known, const Scene& scene, const Plan& plan) {
  if (plan.settings.method != Method::kIrradianceCaching)
    return Refuse("records", "are for irradiance-caching alone: leave them out, or use that");
  const ProtoRecords& records = known.records();
  const v1::RecordsSeal& seal = known.seal();
  if (records.empty()) return Refuse("records", "are none: name a job, or bring those of a result with their seal");
  Diagnostics sealed;
  if (SealOf(seal.world_hash(), SettingsFromProto(seal.gather(), sealed), records).checksum() != seal.checksum())
    return Refuse("records", "do not match their checksum: they were damaged or changed since they were made");
  const std::string mismatch = WhyNotOf(seal, SealOf(scene.world_hash(), plan.settings, {}));
  if (!mismatch.empty()) return Refuse("records", mismatch);
  TakenRecords taken;
  taken.checksum = seal.checksum();
  Diagnostics diagnostics;
  auto fields = std::make_shared<std::vector<RecordField>>(
      RecordsFromProto(records, scene.channels(), "records.records", diagnostics));
  if (!diagnostics.empty()) return MakeDiagnosticsError("BAD_RECORDS", "the records", diagnostics);
  taken.records = std::move(fields);
  return taken;
}

}  // namespace flatlight
