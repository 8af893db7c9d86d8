// SPDX-License-Identifier: Apache-2.0
#include "server/convert/result_read.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "server/convert/result_convert.h"

namespace flatlight {
namespace {

void Add(google::protobuf::RepeatedField<double>& values, int count) {
  for (int i = 0; i < count; ++i) values.Add(0.1 * i - 0.25);
}

// A probe of two points in three channels, with everything that one of its kind can have.
v1::ProbeResult FullProbe(v1::ProbeResult::Quantity quantity) {
  v1::ProbeResult probe;
  probe.set_name("probe");
  probe.set_quantity(quantity);
  probe.set_count(2);
  probe.set_channels(3);
  for (auto* values :
       {probe.mutable_irradiance(), probe.mutable_standard_error(), probe.mutable_gradient(),
        probe.mutable_gradient_error(), probe.mutable_hessian(), probe.mutable_hessian_error(),
        probe.mutable_irradiance_error(), probe.mutable_rotation_gradient(), probe.mutable_rotation_gradient_error(),
        probe.mutable_estimated_error(), probe.mutable_estimated_bias()}) {
    Add(*values, 6);
  }
  Add(*probe.mutable_samples(), 2);
  if (quantity != v1::ProbeResult::IRRADIANCE) {
    probe.set_width(2);
    probe.set_height(1);
  }
  if (quantity == v1::ProbeResult::FLUENCE) {
    Add(*probe.mutable_corners(), 4);
  } else {
    Add(*probe.mutable_positions(), 4);
    Add(*probe.mutable_normals(), 4);
  }
  if (quantity == v1::ProbeResult::IRRADIANCE) Add(*probe.mutable_arc_length(), 2);
  return probe;
}

v1::CacheRecord FullRecord(v1::CacheRecord::Side side) {
  v1::CacheRecord record;
  for (auto* values : {record.mutable_position(), record.mutable_normal(), record.mutable_radius()}) Add(*values, 2);
  v1::Surroundings& seen = *record.mutable_surroundings();
  for (auto* values : {record.mutable_irradiance(), record.mutable_gradient(), record.mutable_hessian(),
                       record.mutable_third(), record.mutable_fourth(), seen.mutable_radiometric()}) {
    Add(*values, 3);
  }
  seen.set_inverse_distance(0.5);
  seen.set_geometric(0.75);
  seen.set_turning(1.25);
  record.set_arc_length(1.5);
  record.set_noise(1e-3);
  record.set_unknown_jump(2e-3);
  record.set_curve("floor");
  record.set_side(side);
  record.set_bounce(0);
  record.set_wave(4);
  return record;
}

// A field that is added to the message must be read back, and be in the tests below.
void ExpectEveryFieldIn(const std::vector<const google::protobuf::Message*>& messages) {
  const auto* descriptor = messages[0]->GetDescriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    const auto* field = descriptor->field(i);
    bool there = false;
    for (const auto* message : messages) {
      const auto* reflection = message->GetReflection();
      there = there || (field->is_repeated() ? reflection->FieldSize(*message, field) > 0
                                             : reflection->HasField(*message, field));
    }
    EXPECT_TRUE(there) << field->full_name();
  }
}

TEST(ResultReadTest, WhatIsReadBackIsWrittenTheSame) {
  v1::RenderResult result;
  result.set_scene("scene");
  result.set_world_hash("world");
  result.set_probe_hash("probes");
  for (const auto quantity : {v1::ProbeResult::IRRADIANCE, v1::ProbeResult::FLUENCE, v1::ProbeResult::RADIANCE}) {
    *result.add_probes() = FullProbe(quantity);
  }
  for (const auto side : {v1::CacheRecord::FRONT, v1::CacheRecord::BACK}) *result.add_records() = FullRecord(side);
  result.mutable_statistics()->set_rays(123);
  result.mutable_statistics()->set_photons(100);
  result.mutable_statistics()->set_error_bound(1e-9);
  result.mutable_statistics()->set_records(2);
  result.mutable_statistics()->set_reused_records(1);
  ExpectEveryFieldIn({&result.probes(0), &result.probes(1)});
  ExpectEveryFieldIn({&result.records(0)});
  ExpectEveryFieldIn({&result.records(0).surroundings()});
  EXPECT_EQ(ResultToProto(OutlineOf(result), FieldOf(result)).DebugString(), result.DebugString());
}

TEST(ResultReadTest, OfNothingThereIsNothing) {
  const v1::RenderResult nothing;
  EXPECT_TRUE(OutlineOf(nothing).probes.empty());
  EXPECT_TRUE(FieldOf(nothing).probes.empty());
  EXPECT_EQ(EndReasonFromProto(v1::END_REASON_UNSPECIFIED), std::nullopt);
  for (const auto reason : {EndReason::kConverged, EndReason::kSamplesDone, EndReason::kTargetReached,
                            EndReason::kTimeLimit, EndReason::kAccuracyLimit}) {
    EXPECT_EQ(EndReasonFromProto(EndReasonToProto(reason)), reason);
  }
}

}  // namespace
}  // namespace flatlight
