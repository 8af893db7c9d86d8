// SPDX-License-Identifier: Apache-2.0
#include "server/service/job_watch.h"

#include "server/service/message_bytes.h"
#include "server/service/status_convert.h"

namespace flatlight {

Watch::Decision JobWatch::DecideWhileWriting(Time now) {
  if (update_ == nullptr) return {};
  const Time stalled = last_write_ + hub_.options().stall;
  if (now < stalled) return {.wake = stalled};
  update_.reset();
  return {};
}

Watch::Decision JobWatch::DecideUpdate(Time now) {
  Decision decision = DecideWrite(update_->Message(next_message_), now);
  if (update_->size() > 1) decision.wake = now + hub_.options().stall;
  return decision;
}

Watch::Decision JobWatch::DecideNext(Time now) {
  if (update_ != nullptr) return DecideUpdate(now);
  const auto job = hub_.jobs().GetWhole(job_);
  if (!job.ok()) return DecideFinish(ToGrpcStatus(job.status()));
  const bool ended = HasEnded(job->state->phase);
  const bool restored = job->state->sequence > 0;  // Until then there is nothing to tell.
  if (restored && (!known_ || job->state->sequence > *known_)) {
    if (ended || now >= next_update_) {
      update_ = hub_.UpdateFor(*job, known_);
      next_message_ = 0;
      // The wait counts from the first picture on: it should come as soon as there is one.
      if (job->state->field != nullptr) next_update_ = now + interval_;
      return DecideUpdate(now);
    }
  } else if (ended) {
    return DecideFinish(grpc::Status::OK);
  }
  const bool behind = known_ && job->state->sequence > *known_;
  return DecideHeartbeat(now, behind ? std::optional(next_update_) : std::nullopt);
}

void JobWatch::NoteWritten() {
  if (update_ == nullptr || ++next_message_ < update_->size()) return;
  ++hub_.counts().updates;
  const std::uint64_t sequence = update_->state().sequence;
  if (known_) hub_.counts().conflated += sequence - *known_ - 1;
  known_ = sequence;
  update_.reset();
}

grpc::ByteBuffer JobWatch::Statement(bool draining) const {
  v1::WatchJobResponse message = Heartbeat(hub_.options().epoch, known_.value_or(0));
  message.set_draining(draining);
  return ToBytes(message);
}

}  // namespace flatlight
