// SPDX-License-Identifier: Apache-2.0
// A review room: what its people look at together, and what they write about it.
#ifndef FLATLIGHT_SERVER_REVIEW_ROOM_H_
#define FLATLIGHT_SERVER_REVIEW_ROOM_H_

#include <chrono>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "server/store/job_id.h"

namespace flatlight {

// The {uuid} of rooms/{uuid}.
class RoomId {
 public:
  static RoomId Random();
  // From "rooms/{uuid}"; nothing if the name has another form.
  static std::optional<RoomId> FromName(std::string_view name);

  std::string Name() const { return "rooms/" + uuid_; }
  const std::string& uuid() const { return uuid_; }
  friend auto operator<=>(const RoomId&, const RoomId&) = default;

 private:
  explicit RoomId(std::string uuid) : uuid_(std::move(uuid)) {}
  std::string uuid_;
};

enum class ToneMapping : std::uint8_t { kPhotographic, kLinear };

// What is looked at.
struct RoomView {
  std::optional<JobId> job = std::nullopt;
  std::string probe = {};                             // Its name; empty: all.
  std::optional<std::uint32_t> point = std::nullopt;  // Of the probe.
  double exposure = 0;                                // Stops.
  ToneMapping tone_mapping = ToneMapping::kPhotographic;
};

// What is absent stays as it is. A new job has no probe and point, a new probe no point, unless they are given too.
struct ViewChange {
  std::optional<std::optional<JobId>> job = std::nullopt;
  std::optional<std::string> probe = std::nullopt;
  std::optional<std::uint32_t> point = std::nullopt;
  std::optional<double> exposure = std::nullopt;
  std::optional<ToneMapping> tone_mapping = std::nullopt;
};

struct Room {
  using Time = std::chrono::time_point<std::chrono::system_clock, std::chrono::milliseconds>;
  RoomId id;
  std::uint64_t epoch = 0;  // Of its sequence. Never 0.
  std::string owner = {};
  std::string title = {};
  Time create_time = {};
  std::optional<Time> close_time = std::nullopt;  // Absent: it is open.
  std::uint64_t sequence = 0;                     // Grows with every note and every change of the view. Never 0.
  std::uint32_t notes = 0;
  RoomView view = {};
};

struct Note {
  std::uint64_t sequence = 0;
  std::string author = {};
  Room::Time time = {};
  std::string text = {};
  std::optional<Point2> place = std::nullopt;  // m.
  std::optional<JobId> job = std::nullopt;     // That was looked at.
};

// What brings one who knows a room up to some sequence nearer to its present.
struct RoomUpdate {
  Room room;                     // As it is now.
  std::vector<Note> notes = {};  // The next ones.
  std::uint64_t sequence = 0;    // To which these bring: the room's own, unless more notes follow.
  bool more() const { return sequence < room.sequence; }
};

struct RoomLimits {
  std::size_t rooms_per_user = 100;
  std::size_t notes = 10'000;       // Of a room.
  std::size_t note_bytes = 2000;    // Of a text.
  std::size_t all_bytes = 4 << 20;  // Of all texts of a room.
  std::size_t title_bytes = 200;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_REVIEW_ROOM_H_
