// SPDX-License-Identifier: Apache-2.0
#include "server/service/watcher.h"

#include "server/service/message_bytes.h"
#include "server/service/status_convert.h"
#include "server/store/error.h"

namespace flatlight {

void Watcher::Step() {
  const std::shared_ptr<Watcher> self = shared_from_this();
  Decision decision;
  {
    const std::lock_guard lock(mutex_);
    decision = Decide(std::chrono::steady_clock::now());
  }
  // `writing_` and `finished_` now keep every other thread from acting.
  if (decision.wake) hub_.StepAt(self, *decision.wake);
  if (decision.finish) Finish(*decision.finish);
  if (decision.write) StartWrite(&bytes_);
}

Watcher::Decision Watcher::Decide(Time now) {
  if (finished_) return {};
  if (writing_ != Write::kNone) {
    if (update_ == nullptr) return {};
    const Time stalled = last_write_ + hub_.options().stall;
    if (now < stalled) return {.wake = stalled};
    update_.reset();
    return {};
  }
  if (broken_) return DecideFinish(grpc::Status(grpc::StatusCode::CANCELLED, "the watcher has gone"));
  if (hub_.draining()) {
    if (!said_draining_) return DecideStatement(Write::kDraining, now);
    return DecideFinish(ToGrpcStatus(
        MakeError(absl::StatusCode::kUnavailable, "DRAINING", "the server is going down; watch again later")));
  }
  if (access_changed_.exchange(false) && may_see_) {
    if (const absl::Status seen = may_see_(); !seen.ok()) return DecideFinish(ToGrpcStatus(seen));
  }
  if (update_ != nullptr) return DecideWrite(Write::kUpdate, update_->Message(next_message_), now);

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
      return DecideWrite(Write::kUpdate, update_->Message(0), now);
    }
  } else if (ended) {
    return DecideFinish(grpc::Status::OK);
  }
  const Time heartbeat = last_write_ + hub_.options().heartbeat;
  if (now >= heartbeat) return DecideStatement(Write::kHeartbeat, now);
  const bool behind = known_ && job->state->sequence > *known_;
  return {.wake = behind ? std::min(heartbeat, next_update_) : heartbeat};
}

Watcher::Decision Watcher::DecideFinish(const grpc::Status& status) {
  finished_ = true;
  update_.reset();
  return {.finish = status};
}

Watcher::Decision Watcher::DecideWrite(Write what, const grpc::ByteBuffer& bytes, Time now) {
  writing_ = what;
  bytes_ = bytes;
  last_write_ = now;
  Decision decision{.write = true};
  if (what == Write::kUpdate && update_->size() > 1) decision.wake = now + hub_.options().stall;
  return decision;
}

Watcher::Decision Watcher::DecideStatement(Write what, Time now) {
  v1::WatchJobResponse message = Heartbeat(hub_.options().epoch, known_.value_or(0));
  if (what == Write::kDraining) {
    message.set_draining(true);
    said_draining_ = true;
  }
  return DecideWrite(what, ToBytes(message), now);
}

void Watcher::OnWriteDone(bool ok) {
  {
    const std::lock_guard lock(mutex_);
    const bool was_update = writing_ == Write::kUpdate && update_ != nullptr;
    writing_ = Write::kNone;
    bytes_.Clear();
    if (!ok) broken_ = true;
    if (was_update && ++next_message_ == update_->size()) {
      ++hub_.counts().updates;
      const std::uint64_t sequence = update_->state().sequence;
      if (known_) hub_.counts().conflated += sequence - *known_ - 1;
      known_ = sequence;
      update_.reset();
    }
  }
  Step();
}

void Watcher::OnCancel() {
  {
    const std::lock_guard lock(mutex_);
    broken_ = true;
  }
  if (on_disconnect_ && !hub_.draining()) on_disconnect_();
  hub_.StepSoon(shared_from_this());
}

void Watcher::OnDone() { hub_.Remove(job_, shared_from_this()); }

}  // namespace flatlight
