// SPDX-License-Identifier: Apache-2.0
#include "server/review/room.h"

#include "server/store/uuid.h"

namespace flatlight {
namespace {

constexpr std::string_view kPrefix = "rooms/";

}  // namespace

RoomId RoomId::Random() { return RoomId(RandomUuid()); }

std::optional<RoomId> RoomId::FromName(std::string_view name) {
  if (!name.starts_with(kPrefix) || !IsUuid(name.substr(kPrefix.size()))) return std::nullopt;
  return RoomId(std::string(name.substr(kPrefix.size())));
}

}  // namespace flatlight
