// SPDX-License-Identifier: Apache-2.0
#include "client/cli/rooms/room_watch.h"

#include "client/cli/connection/message_stream.h"
#include "client/cli/jobs/comeback.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

constexpr std::chrono::seconds kPatience{120};
constexpr std::chrono::seconds kSilence{25};  // Heartbeats come every 10 s.

class Watch {
 public:
  Watch(Connection& connection, const std::string& name, const RoomWatchOptions& options)
      : connection_(connection), options_(options), comeback_(connection, kPatience) {
    request_.set_name(name);
  }

  absl::Status Run() {
    for (;;) {
      const grpc::Status status = ReadStream();
      if (!unwanted_.ok()) return unwanted_;
      if (done_) return absl::OkStatus();
      if (connection_.interruption().Requested()) return InterruptedError("interrupted");
      if (!MayComeBack(status)) return connection_.Explain(status);
      if (absl::Status wait = comeback_.Wait(status); !wait.ok()) return wait;
    }
  }

 private:
  grpc::Status ReadStream() {
    MessageStream<v1::WatchRoomResponse> stream(
        connection_, [this](grpc::ClientContext* context, grpc::CompletionQueue* queue) {
          return connection_.review().PrepareAsyncWatchRoom(context, request_, queue);
        });
    v1::WatchRoomResponse message;
    while (stream.Next(message, kSilence)) {
      Take(message);
      if (done_ || !unwanted_.ok()) return grpc::Status::OK;
    }
    return stream.Finish();
  }

  void Take(const v1::WatchRoomResponse& message) {
    comeback_.Heard();
    const bool first = request_.epoch() == 0;
    if (!first && message.epoch() != request_.epoch()) unwanted_ = options_.on_new_epoch();
    request_.set_epoch(message.epoch());
    request_.set_after_sequence(message.sequence());
    if (!message.has_room() || !unwanted_.ok()) return;
    unwanted_ = options_.on_update(message);
    done_ = !message.more() && (!options_.to_end || message.room().has_close_time());
  }

  Connection& connection_;
  const RoomWatchOptions& options_;
  Comeback comeback_;
  v1::WatchRoomRequest request_;
  absl::Status unwanted_;  // Why no more updates are wanted.
  bool done_ = false;
};

}  // namespace

absl::Status WatchRoom(Connection& connection, const std::string& name, const RoomWatchOptions& options) {
  return Watch(connection, name, options).Run();
}

}  // namespace flatlight
