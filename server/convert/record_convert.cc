// SPDX-License-Identifier: Apache-2.0
#include "server/convert/record_convert.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "server/convert/settings_convert.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

using Values = google::protobuf::RepeatedField<double>;

// JSON does not keep the sign of 0 and the checksum would.
double Plain(double value) { return value + 0.0; }

void Fill(const std::vector<double>& values, Values& out) {
  for (const double value : values) out.Add(Plain(value));
}

std::vector<double> Taken(const Values& values) { return {values.begin(), values.end()}; }

bool AllFinite(const v1::CacheRecord& record) {
  const auto finite = [](const Values& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  const v1::Surroundings& seen = record.surroundings();
  return finite(record.position()) && finite(record.normal()) && finite(record.irradiance()) &&
         finite(record.gradient()) && finite(record.hessian()) && finite(record.third()) && finite(record.fourth()) &&
         finite(seen.radiometric()) && std::isfinite(record.noise()) && std::isfinite(record.unknown_jump()) &&
         std::isfinite(record.arc_length()) && std::isfinite(seen.inverse_distance()) &&
         std::isfinite(seen.geometric()) && std::isfinite(seen.turning());
}

// Whether all arrays have the lengths that they should.
bool HasShape(const v1::CacheRecord& record, int channels) {
  if (record.position_size() != 2 || record.normal_size() != 2 || record.irradiance_size() != channels ||
      record.surroundings().radiometric_size() != channels)
    return false;
  bool known = true;
  for (const Values* values : {&record.gradient(), &record.hessian(), &record.third(), &record.fourth()}) {
    if (!values->empty() && (!known || values->size() != channels)) return false;
    known = !values->empty();
  }
  return true;
}

}  // namespace

void FillRecord(const RecordField& record, v1::CacheRecord& out) {
  out.add_position(Plain(record.position.x)), out.add_position(Plain(record.position.y));
  out.add_normal(Plain(record.normal.x)), out.add_normal(Plain(record.normal.y));
  out.set_curve(record.curve);
  if (!record.curve.empty()) out.set_side(record.side == Side::kFront ? v1::CacheRecord::FRONT : v1::CacheRecord::BACK);
  Fill(record.irradiance, *out.mutable_irradiance());
  Fill(record.gradient, *out.mutable_gradient());
  Fill(record.hessian, *out.mutable_hessian());
  Fill(record.third, *out.mutable_third());
  Fill(record.fourth, *out.mutable_fourth());
  out.set_bounce(0);
  out.set_wave(record.wave);
  if (record.arc_length) out.set_arc_length(Plain(*record.arc_length));
  out.set_noise(Plain(record.noise));
  out.set_unknown_jump(Plain(record.unknown_jump));
  v1::Surroundings& seen = *out.mutable_surroundings();
  if (record.inverse_distance) seen.set_inverse_distance(Plain(*record.inverse_distance));
  Fill(record.radiometric, *seen.mutable_radiometric());
  seen.set_geometric(Plain(record.geometric));
  seen.set_turning(Plain(record.turning));
}

void FillRecords(const std::vector<RecordField>& records, ProtoRecords& out) {
  for (const RecordField& record : records) {
    v1::CacheRecord& added = *out.Add();
    FillRecord(record, added);
    added.add_radius(record.left_radius), added.add_radius(record.right_radius);
  }
}

v1::RecordsSeal SealOf(const std::string& world_hash, const Settings& settings, const ProtoRecords& records) {
  v1::RecordsSeal seal;
  seal.set_world_hash(world_hash);
  Settings gather;
  gather.max_bounces = settings.max_bounces;
  gather.gather = settings.gather;
  if (settings.gather && settings.gather != Gather::kReference)
    gather.samples = settings.samples, gather.seed = settings.seed, gather.photons = settings.photons;
  *seal.mutable_gather() = SettingsToProto(gather);
  Sha256 hash;
  hash.Add(seal.SerializeAsString());
  for (const v1::CacheRecord& record : records) {
    const std::string bytes = record.SerializeAsString();
    hash.Add(std::to_string(bytes.size()) + ":");
    hash.Add(bytes);
  }
  seal.set_checksum(hash.Finish());
  return seal;
}

std::string WhyNotOf(const v1::RecordsSeal& seal, const v1::RecordsSeal& job) {
  if (seal.world_hash() != job.world_hash())
    return "are of another world (" + seal.world_hash().substr(0, 12) + "…, this one is " +
           job.world_hash().substr(0, 12) + "…): geometry, materials and lights must be the same";
  const v1::Settings &theirs = seal.gather(), &ours = job.gather();
  const auto text = [](bool has, std::uint32_t value, const char* without) {
    return has ? std::to_string(value) : std::string(without);
  };
  const auto differ = [](const std::string& name, const std::string& a, const std::string& b) {
    return "were gathered with " + name + " " + a + ", and this job has " + b + ": it must be the same";
  };
  if (theirs.has_max_bounces() != ours.has_max_bounces() || theirs.max_bounces() != ours.max_bounces())
    return differ("max bounces", text(theirs.has_max_bounces(), theirs.max_bounces(), "all"),
                  text(ours.has_max_bounces(), ours.max_bounces(), "all"));
  if (theirs.gather() != ours.gather())
    return differ("gather", v1::Settings::Gather_Name(theirs.gather()), v1::Settings::Gather_Name(ours.gather()));
  if (theirs.has_samples() != ours.has_samples() || theirs.samples() != ours.samples())
    return differ("samples", text(theirs.has_samples(), theirs.samples(), "none"),
                  text(ours.has_samples(), ours.samples(), "none"));
  if (theirs.has_photons() != ours.has_photons() || theirs.photons() != ours.photons())
    return differ("photons", text(theirs.has_photons(), theirs.photons(), "none"),
                  text(ours.has_photons(), ours.photons(), "none"));
  if (theirs.seed() != ours.seed()) return differ("seed", std::to_string(theirs.seed()), std::to_string(ours.seed()));
  return "";
}

RecordField RecordFromProto(const v1::CacheRecord& record) {
  RecordField field;
  field.position = {record.position(0), record.position(1)};
  field.normal = {record.normal(0), record.normal(1)};
  field.curve = record.curve();
  field.side = record.side() == v1::CacheRecord::BACK ? Side::kBack : Side::kFront;
  field.irradiance = Taken(record.irradiance());
  field.gradient = Taken(record.gradient());
  field.hessian = Taken(record.hessian());
  field.third = Taken(record.third());
  field.fourth = Taken(record.fourth());
  field.wave = record.wave();
  if (record.has_arc_length()) field.arc_length = record.arc_length();
  field.noise = record.noise();
  field.unknown_jump = record.unknown_jump();
  const v1::Surroundings& seen = record.surroundings();
  if (seen.has_inverse_distance()) field.inverse_distance = seen.inverse_distance();
  field.radiometric = Taken(seen.radiometric());
  field.geometric = seen.geometric();
  field.turning = seen.turning();
  if (record.radius_size() == 2) {
    field.left_radius = record.radius(0);
    field.right_radius = record.radius(1);
  }
  return field;
}

std::vector<RecordField> RecordsFromProto(const ProtoRecords& records, int channels, const std::string& path,
                                          Diagnostics& diagnostics) {
  std::vector<RecordField> out;
  out.reserve(static_cast<std::size_t>(records.size()));
  for (const v1::CacheRecord& record : records) {
    if (!HasShape(record, channels) || !AllFinite(record)) {
      diagnostics.Add(path + "[" + std::to_string(out.size()) + "]",
                      "is no record of this world: it must have finite values for " + std::to_string(channels) +
                          (channels == 1 ? " channel" : " channels"));
      return {};
    }
    out.push_back(RecordFromProto(record));
  }
  return out;
}

}  // namespace flatlight
