// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/field_versions.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace flatlight {
namespace {

constexpr std::vector<double> ProbeField::*kArrays[] = {
    &ProbeField::irradiance,        &ProbeField::standard_error,
    &ProbeField::gradient,          &ProbeField::gradient_error,
    &ProbeField::hessian,           &ProbeField::hessian_error,
    &ProbeField::samples,           &ProbeField::irradiance_error,
    &ProbeField::rotation_gradient, &ProbeField::rotation_gradient_error,
    &ProbeField::estimated_error,   &ProbeField::estimated_bias};

// Whether the values of points [first, last) have equal bits.
bool EqualValues(const ProbeField& a, const ProbeField& b, std::size_t points, std::size_t first, std::size_t last) {
  for (const auto array : kArrays) {
    const std::vector<double>& x = a.*array;
    const std::vector<double>& y = b.*array;
    if (x.size() != y.size()) return false;
    const std::size_t width = x.size() / points;
    if (width != 0 && std::memcmp(&x[first * width], &y[first * width], (last - first) * width * sizeof(double)) != 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

FieldVersions StampVersions(const SceneOutline& scene, const Field* before, const FieldVersions& before_versions,
                            const Field& after, std::uint64_t sequence) {
  FieldVersions versions;
  versions.log = before_versions.log;
  if (after.records.size() > (before == nullptr ? 0 : before->records.size()))
    versions.log.push_back({sequence, after.records.size()});
  for (std::size_t probe = 0; probe < scene.probes.size(); ++probe) {
    const std::size_t points = scene.probes[probe].points();
    std::vector<std::uint64_t>& changed = versions.changed.emplace_back();
    for (std::size_t first = 0; first < points; first += FieldVersions::kPoints) {
      const std::size_t last = std::min(points, first + FieldVersions::kPoints);
      const bool equal =
          before != nullptr && EqualValues(before->probes[probe], after.probes[probe], points, first, last);
      changed.push_back(equal ? before_versions.changed[probe][first / FieldVersions::kPoints] : sequence);
    }
  }
  return versions;
}

}  // namespace flatlight
