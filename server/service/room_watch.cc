// SPDX-License-Identifier: Apache-2.0
#include "server/service/room_watch.h"

#include "server/service/message_bytes.h"
#include "server/service/room_convert.h"
#include "server/service/status_convert.h"

namespace flatlight {

Watch::Decision RoomWatch::DecideNext(Time now) {
  const auto update = rooms_.ReadAfter(room_, known_);
  if (!update.ok()) return DecideFinish(ToGrpcStatus(update.status()));
  if (update->sequence > known_) {
    next_known_ = update->sequence;
    return DecideWrite(ToBytes(UpdateToProto(*update)), now);
  }
  if (update->room.close_time) return DecideFinish(grpc::Status::OK);
  return DecideHeartbeat(now);
}

grpc::ByteBuffer RoomWatch::Statement(bool draining) const {
  v1::WatchRoomResponse message;
  message.set_epoch(epoch_);
  message.set_sequence(known_);
  message.set_draining(draining);
  return ToBytes(message);
}

}  // namespace flatlight
