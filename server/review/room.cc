// SPDX-License-Identifier: Apache-2.0
#include "server/review/room.h"

namespace flatlight {
namespace {

constexpr std::string_view kPrefix = "rooms/";

}  // namespace

// The uuid of a job's name is as good for a room.
RoomId RoomId::Random() { return RoomId(JobId::Random().uuid()); }

std::optional<RoomId> RoomId::FromName(std::string_view name) {
  if (!name.starts_with(kPrefix)) return std::nullopt;
  const auto id = JobId::FromName("jobs/" + std::string(name.substr(kPrefix.size())));
  return id ? std::optional(RoomId(id->uuid())) : std::nullopt;
}

}  // namespace flatlight
