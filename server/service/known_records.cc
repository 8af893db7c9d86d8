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

absl::StatusOr<TakenRecords> TakeRecords(const v1::KnownRecords& known, const Scene& scene, const Plan& plan,
                                         JobStore& jobs) {
  if (plan.settings.method != Method::kIrradianceCaching)
    return Refuse("records", "are for irradiance-caching alone: leave them out, or use that");
  if (!known.job().empty() && (known.records_size() > 0 || known.has_seal()))
    return Refuse("records.job", "is given together with records: leave one of them out");
  ProtoRecords records = known.records();
  v1::RecordsSeal seal = known.seal();
  const std::string where = known.job().empty() ? "records" : "records.job";
  if (!known.job().empty()) {
    const auto id = ParseJobName(known.job());
    if (!id.ok()) return Refuse("records.job", "\"" + known.job() + "\"; a job is named jobs/{uuid}");
    const auto job = jobs.Get(*id);
    if (!job.ok()) return Refuse("records.job", "\"" + known.job() + "\" is not known here");
    if (!HasEnded(job->state->phase))
      return Refuse("records.job", "has not ended; watch it until it has, or cancel it");
    const auto& field = job->state->field;
    if (field == nullptr || field->records.empty()) return Refuse("records.job", "has made no records");
    FillRecords(field->records, records);
    seal = SealOf(job->spec->scene->world_hash, job->spec->plan.settings, records);
  } else {
    if (records.empty()) return Refuse("records", "are none: name a job, or bring those of a result with their seal");
    Diagnostics diagnostics;
    if (SealOf(seal.world_hash(), SettingsFromProto(seal.gather(), diagnostics), records).checksum() != seal.checksum())
      return Refuse("records", "do not match their checksum: they were damaged or changed since they were made");
  }
  const std::string mismatch = WhyNotOf(seal, SealOf(scene.world_hash(), plan.settings, {}));
  if (!mismatch.empty()) return Refuse(where, mismatch);
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
