// SPDX-License-Identifier: Apache-2.0
#include "client/cli/jobs/watch.h"

#include "client/cli/connection/message_stream.h"
#include "client/cli/jobs/comeback.h"
#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

class Watch {
 public:
  Watch(Connection& connection, const std::string& name, const WatchOptions& options)
      : connection_(connection), options_(options), comeback_(connection, options.patience) {
    request_.set_name(name);
    request_.set_max_rate(options.max_rate);
    request_.set_cancel_on_disconnect(options.cancel_on_disconnect);
  }

  absl::StatusOr<v1::Job> Run() {
    for (;;) {
      const grpc::Status status = ReadStream();
      if (!unwanted_.ok()) return unwanted_;
      if (Done()) return job_;
      if (connection_.interruption().Requested()) return InterruptedError("interrupted");
      if (status.error_code() == grpc::StatusCode::NOT_FOUND && heard_anything_)
        return JobError("the server no longer knows " + request_.name() + "; it was restarted, or the job deleted");
      if (!MayComeBack(status)) return connection_.Explain(status);
      if (absl::Status wait = WaitForNextTry(status); !wait.ok()) return wait;
    }
  }

 private:
  // The state that ended the job comes first; its records may follow.
  bool Done() const { return HasEnded(job_.state()) && (whole_ || !options_.on_record); }

  grpc::Status ReadStream() {
    MessageStream<v1::WatchJobResponse> stream(
        connection_, [this](grpc::ClientContext* context, grpc::CompletionQueue* queue) {
          return connection_.render().PrepareAsyncWatchJob(context, request_, queue);
        });
    v1::WatchJobResponse message;
    while (stream.Next(message, options_.silence)) {
      Take(message);
      if (Done() || !unwanted_.ok()) return grpc::Status::OK;
    }
    return stream.Finish();
  }

  void Take(const v1::WatchJobResponse& message) {
    heard_anything_ = true;
    comeback_.Heard();
    // Of another epoch all begins anew.
    if (request_.epoch() != 0 && message.epoch() != request_.epoch()) records_ = 0;
    TakeRecords(message);
    whole_ = !message.more();
    if (!message.more()) {
      request_.set_epoch(message.epoch());
      request_.set_sequence(message.sequence());
    }
    if (!message.has_job()) return;
    // Later messages leave out what never changes.
    v1::Job job = message.job();
    if (!job.has_plan()) {
      job.set_scene(job_.scene());
      *job.mutable_settings() = job_.settings();
      *job.mutable_plan() = job_.plan();
    }
    job_ = std::move(job);
    if (options_.on_update && unwanted_.ok()) unwanted_ = options_.on_update(job_);
  }

  // What was begun and not ended comes again.
  void TakeRecords(const v1::WatchJobResponse& message) {
    if (!options_.on_record) return;
    for (const v1::RecordUpdate& update : message.records()) {
      for (int i = 0; i < update.records_size() && unwanted_.ok(); ++i) {
        const std::uint32_t index = update.first() + static_cast<std::uint32_t>(i);
        if (index != records_) continue;
        unwanted_ = options_.on_record(index, update.records(i));
        ++records_;
      }
    }
  }

  absl::Status WaitForNextTry(const grpc::Status& status) {
    if (options_.check_server)
      if (absl::Status alive = options_.check_server(); !alive.ok()) return alive;
    return comeback_.Wait(status);
  }

  Connection& connection_;
  const WatchOptions& options_;
  Comeback comeback_;
  v1::WatchJobRequest request_;
  v1::Job job_;
  absl::Status unwanted_;      // Why no more updates are wanted.
  std::uint32_t records_ = 0;  // Received: of the log, in order.
  bool whole_ = false;         // The last message was the last of its state.
  bool heard_anything_ = false;
};

}  // namespace

bool HasEnded(v1::Job::State state) {
  return state == v1::Job::SUCCEEDED || state == v1::Job::FAILED || state == v1::Job::CANCELLED;
}

absl::StatusOr<v1::Job> WatchJob(Connection& connection, const std::string& name, const WatchOptions& options) {
  return Watch(connection, name, options).Run();
}

}  // namespace flatlight
