// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_CONVERT_RECORD_CONVERT_H_
#define FLATLIGHT_SERVER_CONVERT_RECORD_CONVERT_H_

#include <google/protobuf/repeated_field.h>

#include <string>
#include <vector>

#include "core/render/field.h"
#include "core/render/settings.h"
#include "core/scene/diagnostic.h"
#include "flatlight/v1/result.pb.h"

namespace flatlight {

using ProtoRecords = google::protobuf::RepeatedPtrField<v1::CacheRecord>;

// All but the radius, which alone may change while records are made.
void FillRecord(const RecordField& record, v1::CacheRecord& out);
void FillRecords(const std::vector<RecordField>& records, ProtoRecords& out);

// What records of a job with these settings, as they applied, are of.
v1::RecordsSeal SealOf(const std::string& world_hash, const Settings& settings, const ProtoRecords& records);

// Names what does not fit the seal of a job: another world, a setting of the gather. Empty if that job may use records
// of this seal.
std::string WhyNotOf(const v1::RecordsSeal& seal, const v1::RecordsSeal& job);

// The way back, of a record of the right shape.
RecordField RecordFromProto(const v1::CacheRecord& record);

// Records of a request, whose seal has been found right. `path` begins those of mistakes.
std::vector<RecordField> RecordsFromProto(const ProtoRecords& records, int channels, const std::string& path,
                                          Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_CONVERT_RECORD_CONVERT_H_
