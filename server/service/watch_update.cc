// SPDX-License-Identifier: Apache-2.0
#include "server/service/watch_update.h"

#include <algorithm>
#include <utility>

#include "server/convert/record_convert.h"
#include "server/convert/result_convert.h"
#include "server/service/job_convert.h"
#include "server/service/message_bytes.h"

namespace flatlight {
namespace {

// Updates of more messages are serialised anew for each watcher rather than kept.
constexpr std::size_t kMaxKeptMessages = 32;
// Upper bounds: job and progress, and what frames one run of points.
constexpr std::size_t kHeadBytes = 16u << 10;
constexpr std::size_t kFrameBytes = 128;
constexpr std::size_t kRadiusBytes = 2 * sizeof(double);

// Upper bound of a point's bytes in a message: 9 arrays of values, 5 numbers of geometry.
std::size_t BytesPerPoint(const SceneOutline& scene, bool with_values, bool with_geometry) {
  const auto channels = static_cast<std::size_t>(scene.channels);
  return sizeof(double) * ((with_values ? 8 * channels + 1 : 0) + (with_geometry ? 5 : 0));
}

// Upper bound of a record's bytes in a message, without its radius.
std::size_t BytesOf(const RecordField& record) {
  // Position, normal, arc length, noise, unknown jump, and three of what it sees.
  const std::size_t values = 10 + record.irradiance.size() + record.gradient.size() + record.hessian.size() +
                             record.third.size() + record.fourth.size() + record.radiometric.size();
  return kFrameBytes + record.curve.size() + sizeof(double) * values;
}

}  // namespace

WatchUpdate::WatchUpdate(JobRecord job, std::uint64_t epoch, Known known)
    : job_(std::move(job)), epoch_(epoch), known_(Canonical(*job_.state, known)) {
  PlanMessages();
  messages_.resize(contents_.size());
}

WatchUpdate::Known WatchUpdate::Canonical(const JobState& state, Known known) {
  if (!known) return known;
  // Only which versions are newer than the known sequence counts.
  std::uint64_t newest_known = 0;
  for (const auto& probe : state.versions.changed) {
    for (const std::uint64_t version : probe) {
      if (version <= *known) newest_known = std::max(newest_known, version);
    }
  }
  for (const FieldVersions::Growth& growth : state.versions.log)
    if (growth.sequence <= *known) newest_known = std::max(newest_known, growth.sequence);
  return newest_known;
}

void WatchUpdate::TurnPage() {
  contents_.emplace_back();
  room_ = kMaxMessageBytes - kHeadBytes;
}

void WatchUpdate::PlanMessages() {
  TurnPage();
  if (known_ && job_.state->field == nullptr) return;
  PlanPoints();
  if (job_.state->field != nullptr) PlanRecords();
}

void WatchUpdate::PlanPoints() {
  const SceneOutline& scene = *job_.spec->scene;
  const JobState& state = *job_.state;
  const std::size_t bytes_per_point = BytesPerPoint(scene, state.field != nullptr, !known_);
  for (std::size_t probe = 0; probe < scene.probes.size(); ++probe) {
    const std::size_t points = scene.probes[probe].points();
    const std::size_t frame_bytes = kFrameBytes + (known_ ? 0 : scene.probes[probe].name.size());
    for (std::size_t run = 0; run * FieldVersions::kPoints < points; ++run) {
      if (known_ && state.versions.changed[probe][run] <= *known_) continue;
      std::size_t first = run * FieldVersions::kPoints;
      const std::size_t last = std::min(points, first + FieldVersions::kPoints);
      while (first < last) {
        const Cut* open = contents_.back().points.empty() ? nullptr : &contents_.back().points.back();
        const bool follows = open != nullptr && open->probe == probe && open->first + open->count == first;
        const std::size_t frame = follows ? 0 : frame_bytes;
        if (open != nullptr && room_ < frame + bytes_per_point) {
          TurnPage();
          continue;
        }
        const std::size_t fit = room_ > frame ? (room_ - frame) / bytes_per_point : 0;
        const std::size_t count = std::clamp<std::size_t>(fit, 1, last - first);
        if (!follows) contents_.back().points.push_back({probe, first, 0});
        contents_.back().points.back().count += count;
        first += count;
        room_ -= std::min(room_, frame + count * bytes_per_point);
      }
    }
  }
}

void WatchUpdate::PlanRecords() {
  const std::vector<RecordField>& records = job_.state->field->records;
  const std::size_t before = known_ ? job_.state->versions.RecordsAt(*known_) : 0;
  if (before >= records.size()) return;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool radii_alone = i < before;
    const std::size_t bytes = kRadiusBytes + (radii_alone ? 0 : BytesOf(records[i]));
    if (room_ < kFrameBytes + bytes) TurnPage();
    std::vector<RecordCut>& cuts = contents_.back().records;
    if (cuts.empty() || cuts.back().radii_alone != radii_alone) {
      cuts.push_back({i, 0, radii_alone});
      room_ -= kFrameBytes;
    }
    ++cuts.back().count;
    room_ -= std::min(room_, bytes);
  }
}

v1::WatchJobResponse WatchUpdate::Build(std::size_t index) const {
  const SceneOutline& scene = *job_.spec->scene;
  const JobState& state = *job_.state;
  v1::WatchJobResponse message = Heartbeat(epoch_, state.sequence);
  message.set_more(index + 1 < contents_.size());
  if (index == 0) *message.mutable_job() = JobToProto(*job_.spec, state, known_ ? JobView::kChanging : JobView::kWhole);
  for (const Cut& cut : contents_[index].points) {
    v1::FieldUpdate& update = *message.add_updates();
    update.set_probe(static_cast<std::uint32_t>(cut.probe));
    update.set_first(static_cast<std::uint32_t>(cut.first));
    v1::ProbeResult& points = *update.mutable_points();
    if (!known_) {
      FillProbeGeometry(scene, cut.probe, cut.first, cut.count, points);
      points.set_count(static_cast<std::uint32_t>(cut.count));
      points.set_channels(static_cast<std::uint32_t>(scene.channels));
    }
    if (state.field != nullptr) {
      FillProbeValues(*state.field, scene.channels, cut.probe, cut.first, cut.count, points);
    }
  }
  for (const RecordCut& cut : contents_[index].records) {
    v1::RecordUpdate& update = *message.add_records();
    update.set_first(static_cast<std::uint32_t>(cut.first));
    for (std::size_t i = cut.first; i < cut.first + cut.count; ++i) {
      const RecordField& record = state.field->records[i];
      if (!cut.radii_alone) FillRecord(record, *update.add_records());
      update.add_radius(record.left_radius), update.add_radius(record.right_radius);
    }
  }
  return message;
}

grpc::ByteBuffer WatchUpdate::Message(std::size_t index) {
  if (index >= kMaxKeptMessages) return ToBytes(Build(index));
  const std::lock_guard lock(mutex_);
  std::optional<grpc::ByteBuffer>& kept = messages_[index];
  if (!kept) kept = ToBytes(Build(index));
  return *kept;
}

v1::WatchJobResponse Heartbeat(std::uint64_t epoch, std::uint64_t sequence) {
  v1::WatchJobResponse message;
  message.set_epoch(epoch);
  message.set_sequence(sequence);
  return message;
}

}  // namespace flatlight
