// SPDX-License-Identifier: Apache-2.0
#include "server/convert/result_convert.h"

#include <google/protobuf/repeated_field.h>

#include <algorithm>
#include <vector>

#include "core/math/check.h"
#include "server/convert/record_convert.h"

namespace flatlight {
namespace {

using Values = google::protobuf::RepeatedField<double>;

// Entries [first, first + count) of a flat array with `width` values an entry. An empty array stays absent.
void AddSlice(const std::vector<double>& values, std::size_t first, std::size_t count, std::size_t width, Values& out) {
  if (values.empty()) return;
  FLATLIGHT_DCHECK((first + count) * width <= values.size());
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first * width);
  out.Add(begin, begin + static_cast<std::ptrdiff_t>(count * width));
}

}  // namespace

void FillProbeGeometry(const SceneOutline& scene, std::size_t probe, std::size_t first, std::size_t count,
                       v1::ProbeResult& out) {
  const Probe& source = scene.probes[probe];
  FLATLIGHT_DCHECK(first + count <= source.points());
  out.set_name(source.name);
  if (source.picture) {
    out.set_quantity(v1::ProbeResult::FLUENCE);
    out.set_width(source.picture->width);
    out.set_height(source.picture->height);
    if (out.corners().empty()) {
      for (const Point2 corner : {source.picture->low, source.picture->high}) {
        const Point2 world = scene.ToWorld(corner);
        out.add_corners(world.x), out.add_corners(world.y);
      }
    }
    return;
  }
  out.set_quantity(source.camera ? v1::ProbeResult::RADIANCE : v1::ProbeResult::IRRADIANCE);
  if (source.camera) {
    out.set_width(static_cast<std::uint32_t>(source.points()));
    out.set_height(1);
  }
  const bool on_curve = source.curve != CurveId::kNone;
  const int size = static_cast<int>(count);
  out.mutable_positions()->Reserve(out.positions_size() + 2 * size);
  out.mutable_normals()->Reserve(out.normals_size() + 2 * size);
  if (on_curve) out.mutable_arc_length()->Reserve(out.arc_length_size() + size);
  for (std::size_t i = first; i < first + count; ++i) {
    const Receiver& receiver = source.receivers[i];
    const Point2 position = scene.ToWorld(receiver.position + receiver.offset);
    out.add_positions(position.x);
    out.add_positions(position.y);
    out.add_normals(receiver.normal.x);
    out.add_normals(receiver.normal.y);
    if (on_curve) out.add_arc_length(scene.frame.scale * receiver.arc_length);
  }
}

void FillProbeValues(const Field& field, int channels, std::size_t probe, std::size_t first, std::size_t count,
                     v1::ProbeResult& out) {
  const ProbeField& source = field.probes[probe];
  const auto width = static_cast<std::size_t>(channels);
  out.set_count(static_cast<std::uint32_t>(count));
  out.set_channels(static_cast<std::uint32_t>(channels));
  AddSlice(source.irradiance, first, count, width, *out.mutable_irradiance());
  AddSlice(source.standard_error, first, count, width, *out.mutable_standard_error());
  AddSlice(source.irradiance_error, first, count, width, *out.mutable_irradiance_error());
  AddSlice(source.estimated_error, first, count, width, *out.mutable_estimated_error());
  AddSlice(source.estimated_bias, first, count, width, *out.mutable_estimated_bias());
  AddSlice(source.gradient, first, count, width, *out.mutable_gradient());
  AddSlice(source.gradient_error, first, count, width, *out.mutable_gradient_error());
  AddSlice(source.hessian, first, count, width, *out.mutable_hessian());
  AddSlice(source.hessian_error, first, count, width, *out.mutable_hessian_error());
  AddSlice(source.rotation_gradient, first, count, width, *out.mutable_rotation_gradient());
  AddSlice(source.rotation_gradient_error, first, count, width, *out.mutable_rotation_gradient_error());
  AddSlice(source.samples, first, count, 1, *out.mutable_samples());
}

v1::RenderResult ResultToProto(const SceneOutline& scene, const Field& field) {
  v1::RenderResult result;
  result.set_scene(scene.name);
  result.set_world_hash(scene.world_hash);
  result.set_probe_hash(scene.probe_hash);
  for (std::size_t probe = 0; probe < scene.probes.size(); ++probe) {
    const std::size_t count = scene.probes[probe].points();
    v1::ProbeResult& out = *result.add_probes();
    FillProbeGeometry(scene, probe, 0, count, out);
    FillProbeValues(field, scene.channels, probe, 0, count, out);
  }
  double unsampled = 0;
  for (const ProbeField& probe : field.probes)
    unsampled += static_cast<double>(std::count(probe.samples.begin(), probe.samples.end(), 0.0));
  if (unsampled > 0) result.mutable_statistics()->set_unsampled_points(unsampled);
  if (!field.records.empty()) result.mutable_statistics()->set_records(static_cast<double>(field.records.size()));
  FillRecords(field.records, *result.mutable_records());
  if (field.reused_records > 0)
    result.mutable_statistics()->set_reused_records(static_cast<double>(field.reused_records));
  if (field.photons) result.mutable_statistics()->set_photons(*field.photons);
  result.mutable_statistics()->set_rays(field.rays);
  if (field.error_bound) result.mutable_statistics()->set_error_bound(*field.error_bound);
  return result;
}

v1::EndReason EndReasonToProto(EndReason reason) {
  switch (reason) {
    case EndReason::kConverged:
      return v1::CONVERGED;
    case EndReason::kSamplesDone:
      return v1::SAMPLES_DONE;
    case EndReason::kTargetReached:
      return v1::TARGET_REACHED;
    case EndReason::kTimeLimit:
      return v1::TIME_LIMIT;
    case EndReason::kAccuracyLimit:
      return v1::ACCURACY_LIMIT;
  }
  return v1::END_REASON_UNSPECIFIED;
}

v1::SceneTraits TraitsToProto(const SceneTraits& traits) {
  v1::SceneTraits proto;
  proto.set_curves(static_cast<double>(traits.curves));
  proto.set_elements(static_cast<double>(traits.elements));
  proto.set_emitters(static_cast<double>(traits.emitting_curves));
  proto.set_probe_points(static_cast<double>(traits.probe_points));
  proto.set_max_reflectance(traits.max_reflectance);
  proto.set_grey(traits.grey);
  proto.set_pixels(static_cast<double>(traits.pixels));
  proto.set_lambertian(traits.lambertian);
  return proto;
}

}  // namespace flatlight
