// SPDX-License-Identifier: Apache-2.0
// Reading from a server's stream with a bound on silence.
#ifndef FLATLIGHT_CLIENT_CLI_CONNECTION_MESSAGE_STREAM_H_
#define FLATLIGHT_CLIENT_CLI_CONNECTION_MESSAGE_STREAM_H_

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "client/cli/connection/connection.h"
#include "grpcpp/completion_queue.h"
#include "grpcpp/support/async_stream.h"

namespace flatlight {

template <class Response>
class MessageStream {
 public:
  using Reader = grpc::ClientAsyncReader<Response>;

  // `prepare(context, queue)` calls one of a stub's PrepareAsync methods. A signal ends the stream.
  template <class Prepare>
  MessageStream(Connection& connection, Prepare prepare) : connection_(connection), context_(connection.NewContext()) {
    connection_.interruption().Guard(context_.get());
    reader_ = prepare(context_.get(), &queue_);
    reader_->StartCall(this);
    started_ = Await(std::chrono::system_clock::now() + kPatience);
  }

  ~MessageStream() {
    context_->TryCancel();
    connection_.interruption().Guard(nullptr);
    queue_.Shutdown();
    void* tag = nullptr;
    bool ok = false;
    while (queue_.Next(&tag, &ok)) continue;
  }

  MessageStream(const MessageStream&) = delete;
  MessageStream& operator=(const MessageStream&) = delete;

  // False when the stream has ended, or was silent for longer than `silence`: ask Finish.
  bool Next(Response& message, std::chrono::milliseconds silence) {
    if (!started_) return false;
    reader_->Read(&message, this);
    return Await(std::chrono::system_clock::now() + silence);
  }

  // How the stream ended. DEADLINE_EXCEEDED if it was silent.
  grpc::Status Finish() {
    grpc::Status status;
    reader_->Finish(&status, this);
    WaitForEvent();
    return silent_ ? grpc::Status(grpc::StatusCode::DEADLINE_EXCEEDED, "the stream fell silent") : status;
  }

 private:
  static constexpr std::chrono::seconds kPatience{5};

  bool WaitForEvent() {
    void* tag = nullptr;
    bool ok = false;
    queue_.Next(&tag, &ok);
    return ok;
  }

  // Every operation has ended when this returns, so its message may go.
  bool Await(std::chrono::system_clock::time_point deadline) {
    void* tag = nullptr;
    bool ok = false;
    if (queue_.AsyncNext(&tag, &ok, deadline) == grpc::CompletionQueue::GOT_EVENT) return ok;
    silent_ = true;
    context_->TryCancel();
    WaitForEvent();
    return false;
  }

  Connection& connection_;
  std::unique_ptr<grpc::ClientContext> context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<Reader> reader_;
  bool started_ = false;
  bool silent_ = false;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_CONNECTION_MESSAGE_STREAM_H_
