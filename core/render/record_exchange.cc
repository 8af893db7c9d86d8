// SPDX-License-Identifier: Apache-2.0
#include "core/render/record_exchange.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace flatlight {
namespace {

// In normalised units: records of another scene with the same world may have been made in another frame.
constexpr double kSamePlace = 1e-9;

// World units of the derivatives, in their order.
struct DerivativeUnits {
  std::array<double, kRecordOrders> unit;

  explicit DerivativeUnits(const Frame& frame) {
    unit[0] = frame.radiance_scale;
    for (std::size_t k = 1; k < kRecordOrders; ++k) unit[k] = unit[k - 1] / frame.scale;
  }
};

constexpr std::vector<double> RecordField::*kDerivatives[kRecordOrders] = {
    &RecordField::irradiance, &RecordField::gradient, &RecordField::hessian, &RecordField::third, &RecordField::fourth};

void Append(const Spectrum& value, double unit, int channels, std::vector<double>& out) {
  for (int c = 0; c < channels; ++c) out.push_back(unit * value[c]);
}

Spectrum Taken(const std::vector<double>& values, double unit) {
  if (values.size() == 1) return Spectrum::Grey(values[0] / unit);
  Spectrum spectrum;
  for (std::size_t c = 0; c < values.size(); ++c) spectrum.value[c] = values[c] / unit;
  return spectrum;
}

}  // namespace

RecordField ToWorld(const CacheRecord& record, const Track& track, const Scene& scene) {
  const DerivativeUnits units(scene.frame());
  const double length = scene.frame().scale;
  const int channels = scene.channels();
  RecordField out;
  const Receiver receiver = track.At(record.at);
  out.position = scene.ToWorld(receiver.position);
  out.normal = receiver.normal;
  if (track.curve() != CurveId::kNone) out.curve = scene.curve(track.curve()).name;
  out.side = track.side();
  if (track.by_arc_length()) out.arc_length = length * record.at;
  for (std::size_t k = 0; k < record.known; ++k)
    Append(record.derivative[k], units.unit[k], channels, out.*kDerivatives[k]);
  out.noise = units.unit[0] * record.noise;
  out.unknown_jump = units.unit[1] * record.unknown_jump;
  const Surroundings& seen = record.surroundings;
  if (seen.inverse_distance) out.inverse_distance = *seen.inverse_distance / length;
  Append(seen.radiometric, units.unit[2], channels, out.radiometric);
  out.geometric = seen.geometric / length / length;
  out.turning = seen.turning / length / length;
  out.wave = record.wave;
  out.left_radius = length * record.left_radius;
  out.right_radius = length * record.right_radius;
  return out;
}

std::optional<CacheRecord> FromWorld(const RecordField& record, const Tracks& tracks, const Scene& scene) {
  const Frame& frame = scene.frame();
  const DerivativeUnits units(frame);
  const Point2 position = {(record.position.x - frame.origin.x) / frame.scale,
                           (record.position.y - frame.origin.y) / frame.scale};
  for (std::size_t t = 0; t < tracks.tracks.size(); ++t) {
    const Track& track = tracks.tracks[t];
    if (track.by_arc_length() != record.arc_length.has_value()) continue;
    if (track.curve() != CurveId::kNone && track.side() != record.side) continue;
    const double at = record.arc_length ? *record.arc_length / frame.scale : track.CoordinateOf(position);
    if (!(at >= tracks.points[t].front() && at <= tracks.points[t].back())) continue;
    const Receiver there = track.At(at);
    if (!(Length(there.position - position) <= kSamePlace && Length(there.normal - record.normal) <= kSamePlace))
      continue;
    CacheRecord out;
    out.track = static_cast<std::uint32_t>(t);
    out.at = at;
    out.wave = record.wave;
    out.known = 0;
    while (out.known < kRecordOrders && !(record.*kDerivatives[out.known]).empty()) {
      out.derivative[out.known] = Taken(record.*kDerivatives[out.known], units.unit[out.known]);
      ++out.known;
    }
    if (out.known == 0) return std::nullopt;
    out.noise = record.noise / units.unit[0];
    out.unknown_jump = record.unknown_jump / units.unit[1];
    if (record.inverse_distance) out.surroundings.inverse_distance = *record.inverse_distance * frame.scale;
    out.surroundings.radiometric = Taken(record.radiometric, units.unit[2]);
    out.surroundings.geometric = record.geometric * frame.scale * frame.scale;
    out.surroundings.turning = record.turning * frame.scale * frame.scale;
    return out;
  }
  return std::nullopt;
}

}  // namespace flatlight
