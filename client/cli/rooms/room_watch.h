// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CLIENT_CLI_ROOMS_ROOM_WATCH_H_
#define FLATLIGHT_CLIENT_CLI_ROOMS_ROOM_WATCH_H_

#include <functional>
#include <string>

#include "absl/status/status.h"
#include "client/cli/connection/connection.h"

namespace flatlight {

struct RoomWatchOptions {
  bool to_end = true;  // Until the room is closed; else only what there is.
  // With each message that says something; each note comes once. An error ends the watch.
  std::function<absl::Status(const v1::WatchRoomResponse&)> on_update;
  // The server went back to a backup: all comes again.
  std::function<absl::Status()> on_new_epoch;
};

// A stream that breaks is taken up again where it ended, for 120 s without a message. INTERRUPTED after a signal.
absl::Status WatchRoom(Connection& connection, const std::string& name, const RoomWatchOptions& options);

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_ROOMS_ROOM_WATCH_H_
