// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_ROOM_WATCH_H_
#define FLATLIGHT_SERVER_SERVICE_ROOM_WATCH_H_

#include <utility>

#include "server/review/room_store.h"
#include "server/service/watch.h"

namespace flatlight {

// A WatchRoom stream.
class RoomWatch final : public Watch {
 public:
  // The reader has all to `known`, in the sequence of `epoch`.
  RoomWatch(WatchHub& hub, RoomStore& rooms, const RoomId& room, std::uint64_t epoch, std::uint64_t known, Hooks hooks)
      : Watch(hub, room.Name(), std::move(hooks)), rooms_(rooms), room_(room), epoch_(epoch), known_(known) {}

 private:
  Decision DecideNext(Time now) override ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void NoteWritten() override ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { known_ = next_known_; }
  grpc::ByteBuffer Statement(bool draining) const override ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  RoomStore& rooms_;
  const RoomId room_;
  const std::uint64_t epoch_;
  std::uint64_t known_ ABSL_GUARDED_BY(mutex_);
  std::uint64_t next_known_ ABSL_GUARDED_BY(mutex_) = 0;  // Once what is in flight has been taken.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_ROOM_WATCH_H_
