// SPDX-License-Identifier: Apache-2.0
#include "server/service/watch.h"

#include <algorithm>

#include "server/service/status_convert.h"
#include "server/store/error.h"

namespace flatlight {

void Watch::Step() {
  const std::shared_ptr<Watch> self = shared_from_this();
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

Watch::Decision Watch::Decide(Time now) {
  if (finished_) return {};
  if (writing_ == Write::kNews) return DecideWhileWriting(now);
  if (writing_ != Write::kNone) return {};
  if (broken_) return DecideFinish(grpc::Status(grpc::StatusCode::CANCELLED, "the watcher has gone"));
  if (hub_.draining()) {
    if (!said_draining_) return DecideStatement(true, now);
    return DecideFinish(ToGrpcStatus(MakeDrainingError()));
  }
  if (const absl::Status may_go_on = CheckWatcher(); !may_go_on.ok()) return DecideFinish(ToGrpcStatus(may_go_on));
  return DecideNext(now);
}

absl::Status Watch::CheckWatcher() {
  if (users_changed_.exchange(false) && hooks_.is_known) {
    if (absl::Status known = hooks_.is_known(); !known.ok()) return known;
  }
  if (access_changed_.exchange(false) && hooks_.may_see) return hooks_.may_see();
  return absl::OkStatus();
}

Watch::Decision Watch::DecideFinish(const grpc::Status& status) {
  finished_ = true;
  NoteFinish();
  return {.finish = status};
}

Watch::Decision Watch::DecideWrite(const grpc::ByteBuffer& bytes, Time now) {
  writing_ = Write::kNews;
  bytes_ = bytes;
  last_write_ = now;
  return {.write = true};
}

Watch::Decision Watch::DecideHeartbeat(Time now, std::optional<Time> wake) {
  const Time heartbeat = last_write_ + hub_.options().heartbeat;
  if (now >= heartbeat) return DecideStatement(false, now);
  return {.wake = std::min(heartbeat, wake.value_or(heartbeat))};
}

Watch::Decision Watch::DecideStatement(bool draining, Time now) {
  if (draining) said_draining_ = true;
  Decision decision = DecideWrite(Statement(draining), now);
  writing_ = Write::kStatement;
  return decision;
}

void Watch::OnWriteDone(bool ok) {
  {
    const std::lock_guard lock(mutex_);
    const bool was_news = writing_ == Write::kNews;
    writing_ = Write::kNone;
    bytes_.Clear();
    if (!ok) broken_ = true;
    if (was_news) NoteWritten();
  }
  Step();
}

void Watch::OnCancel() {
  {
    const std::lock_guard lock(mutex_);
    broken_ = true;
  }
  if (hooks_.on_disconnect && !hub_.draining()) hooks_.on_disconnect();
  hub_.StepSoon(shared_from_this());
}

void Watch::OnDone() { hub_.Remove(subject_, shared_from_this()); }

}  // namespace flatlight
