// SPDX-License-Identifier: Apache-2.0
#include "server/service/room_convert.h"

#include <cmath>

#include "server/service/job_convert.h"
#include "server/service/status_convert.h"

namespace flatlight {
namespace {

constexpr std::size_t kMaxProbeNameBytes = 256;
constexpr double kMaxExposure = 32;

absl::StatusOr<std::optional<ToneMapping>> ToneMappingFromProto(v1::ToneMapping mapping) {
  switch (mapping) {
    case v1::TONE_MAPPING_UNSPECIFIED:
      return std::nullopt;
    case v1::PHOTOGRAPHIC:
      return ToneMapping::kPhotographic;
    case v1::LINEAR:
      return ToneMapping::kLinear;
    default:
      return MakeFieldError("tone_mapping", std::to_string(mapping) + "; allowed: PHOTOGRAPHIC, LINEAR");
  }
}

v1::View ViewToProto(const RoomView& view) {
  v1::View out;
  if (view.job) out.set_job(view.job->Name());
  out.set_probe(view.probe);
  if (view.point) out.set_point(*view.point);
  out.set_exposure(view.exposure);
  out.set_tone_mapping(view.tone_mapping == ToneMapping::kLinear ? v1::LINEAR : v1::PHOTOGRAPHIC);
  return out;
}

}  // namespace

v1::Room RoomToProto(const Room& room) {
  v1::Room out;
  out.set_name(room.id.Name());
  out.set_title(room.title);
  out.set_owner(room.owner);
  SetTime(room.create_time, *out.mutable_create_time());
  if (room.close_time) SetTime(*room.close_time, *out.mutable_close_time());
  out.set_sequence(room.sequence);
  out.set_notes(room.notes);
  *out.mutable_view() = ViewToProto(room.view);
  return out;
}

v1::Note NoteToProto(const Note& note) {
  v1::Note out;
  out.set_sequence(note.sequence);
  out.set_author(note.author);
  SetTime(note.time, *out.mutable_time());
  out.set_text(note.text);
  if (note.place) {
    out.mutable_place()->set_x(note.place->x);
    out.mutable_place()->set_y(note.place->y);
  }
  if (note.job) out.set_job(note.job->Name());
  return out;
}

v1::WatchRoomResponse UpdateToProto(const RoomUpdate& update) {
  v1::WatchRoomResponse out;
  out.set_epoch(update.room.epoch);
  out.set_sequence(update.sequence);
  *out.mutable_room() = RoomToProto(update.room);
  for (const Note& note : update.notes) *out.add_notes() = NoteToProto(note);
  out.set_more(update.more());
  return out;
}

absl::StatusOr<RoomId> ParseRoomName(const std::string& name) {
  if (const auto id = RoomId::FromName(name)) return *id;
  return MakeFieldError("name", "\"" + name + "\"; a room is named rooms/{uuid}");
}

absl::StatusOr<ViewChange> ViewChangeFromProto(const v1::LookAtRequest& request) {
  ViewChange change;
  if (request.has_job()) {
    const auto job = JobId::FromName(request.job());
    if (!job && !request.job().empty()) {
      return MakeFieldError("job", "\"" + request.job() + "\"; a job is named jobs/{uuid}; empty: none");
    }
    change.job = job;
  }
  if (request.has_probe()) {
    if (request.probe().size() > kMaxProbeNameBytes) {
      return MakeFieldError("probe", std::to_string(request.probe().size()) + " bytes; allowed: at most " +
                                         std::to_string(kMaxProbeNameBytes));
    }
    change.probe = request.probe();
  }
  if (request.has_point()) change.point = request.point();
  if (request.has_exposure()) {
    if (!(std::abs(request.exposure()) <= kMaxExposure)) {
      return MakeFieldError("exposure", std::to_string(request.exposure()) + "; allowed: -32 to 32 (stops)");
    }
    change.exposure = request.exposure();
  }
  const auto mapping = ToneMappingFromProto(request.tone_mapping());
  if (!mapping.ok()) return mapping.status();
  change.tone_mapping = *mapping;
  return change;
}

absl::StatusOr<Note> NoteFromProto(const v1::AddNoteRequest& request, const RoomLimits& limits) {
  Note note;
  note.text = request.text();
  if (note.text.empty() || note.text.size() > limits.note_bytes) {
    return MakeFieldError(
        "text", std::to_string(note.text.size()) + " bytes; allowed: 1 to " + std::to_string(limits.note_bytes));
  }
  if (request.has_place()) {
    const v1::Point2& place = request.place();
    if (!place.has_x() || !place.has_y() || !std::isfinite(place.x()) || !std::isfinite(place.y())) {
      return MakeFieldError("place", "wants finite x and y (m)");
    }
    note.place = Point2{place.x(), place.y()};
  }
  return note;
}

}  // namespace flatlight
