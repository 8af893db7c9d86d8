// SPDX-License-Identifier: Apache-2.0
#include "server/convert/result_read.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "server/convert/record_convert.h"

namespace flatlight {
namespace {

std::vector<double> ValuesOf(const google::protobuf::RepeatedField<double>& values) {
  return {values.begin(), values.end()};
}

Point2 PointAt(const google::protobuf::RepeatedField<double>& coordinates, int i) {
  return {coordinates[2 * i], coordinates[2 * i + 1]};
}

Probe ProbeOf(const v1::ProbeResult& result) {
  Probe probe;
  probe.name = result.name();
  if (result.quantity() == v1::ProbeResult::FLUENCE) {
    PixelGrid& picture = probe.picture.emplace();
    picture.width = result.width();
    picture.height = result.height();
    if (result.corners_size() == 4) {
      picture.low = PointAt(result.corners(), 0);
      picture.high = PointAt(result.corners(), 1);
    }
    return probe;
  }
  probe.camera = result.quantity() == v1::ProbeResult::RADIANCE;
  if (result.arc_length_size() > 0) probe.curve = CurveId{0};  // Any.
  const int points = std::min(result.positions_size(), result.normals_size()) / 2;
  for (int i = 0; i < points; ++i) {
    Receiver& receiver = probe.receivers.emplace_back();
    receiver.position = PointAt(result.positions(), i);
    receiver.normal = {result.normals(2 * i), result.normals(2 * i + 1)};
    if (i < result.arc_length_size()) receiver.arc_length = result.arc_length(i);
  }
  return probe;
}

}  // namespace

SceneOutline OutlineOf(const v1::RenderResult& result) {
  SceneOutline outline;
  outline.name = result.scene();
  outline.world_hash = result.world_hash();
  outline.probe_hash = result.probe_hash();
  for (const v1::ProbeResult& probe : result.probes()) {
    outline.channels = static_cast<int>(probe.channels());
    Probe& added = outline.probes.emplace_back(ProbeOf(probe));
    (added.picture ? outline.traits.pixels : outline.traits.probe_points) += added.points();
  }
  return outline;
}

Field FieldOf(const v1::RenderResult& result) {
  Field field;
  for (const v1::ProbeResult& source : result.probes()) {
    ProbeField& probe = field.probes.emplace_back();
    probe.irradiance = ValuesOf(source.irradiance());
    probe.standard_error = ValuesOf(source.standard_error());
    probe.irradiance_error = ValuesOf(source.irradiance_error());
    probe.estimated_error = ValuesOf(source.estimated_error());
    probe.estimated_bias = ValuesOf(source.estimated_bias());
    probe.gradient = ValuesOf(source.gradient());
    probe.gradient_error = ValuesOf(source.gradient_error());
    probe.hessian = ValuesOf(source.hessian());
    probe.hessian_error = ValuesOf(source.hessian_error());
    probe.rotation_gradient = ValuesOf(source.rotation_gradient());
    probe.rotation_gradient_error = ValuesOf(source.rotation_gradient_error());
    probe.samples = ValuesOf(source.samples());
  }
  for (const v1::CacheRecord& record : result.records()) field.records.push_back(RecordFromProto(record));
  field.reused_records = static_cast<std::size_t>(result.statistics().reused_records());
  if (result.statistics().has_photons()) field.photons = result.statistics().photons();
  field.rays = result.statistics().rays();
  if (result.statistics().has_error_bound()) field.error_bound = result.statistics().error_bound();
  return field;
}

std::optional<EndReason> EndReasonFromProto(v1::EndReason reason) {
  switch (reason) {
    case v1::CONVERGED:
      return EndReason::kConverged;
    case v1::SAMPLES_DONE:
      return EndReason::kSamplesDone;
    case v1::TARGET_REACHED:
      return EndReason::kTargetReached;
    case v1::TIME_LIMIT:
      return EndReason::kTimeLimit;
    case v1::ACCURACY_LIMIT:
      return EndReason::kAccuracyLimit;
    default:
      return std::nullopt;
  }
}

}  // namespace flatlight
