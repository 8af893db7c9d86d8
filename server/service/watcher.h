// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_WATCHER_H_
#define FLATLIGHT_SERVER_SERVICE_WATCHER_H_

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "grpcpp/support/server_callback.h"
#include "server/service/watch_hub.h"
#include "server/service/watch_update.h"

namespace flatlight {

// One WatchJob stream: a cursor into a job's state and at most one write in flight. A slow reader gets fewer, newer
// messages; nothing queues up.
class Watcher final : public grpc::ServerWriteReactor<grpc::ByteBuffer>, public std::enable_shared_from_this<Watcher> {
 public:
  using Time = WatchHub::Time;

  // `known`: what the reader has already. Updates begin at least `interval` apart, except the last one.
  // `on_disconnect`, which may be empty, is called at most once: when the reader goes while the server is up.
  // `may_see` says, at the beginning and after NoteAccessChange, with what error the watch ends; empty: with none.
  Watcher(WatchHub& hub, const JobId& job, WatchUpdate::Known known, std::chrono::nanoseconds interval,
          std::function<void()> on_disconnect, std::function<absl::Status()> may_see)
      : hub_(hub),
        job_(job),
        interval_(interval),
        on_disconnect_(std::move(on_disconnect)),
        may_see_(std::move(may_see)),
        known_(known) {}

  // Writes, finishes or waits, as the job, the reader and the clock ask for. May be called at any time.
  void Step();

  // Heeded by the next step.
  void NoteAccessChange() { access_changed_ = true; }

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

  // The hub's, guarded by its mutex.
  std::optional<Time> wake_time;
  bool removed = false;

 private:
  enum class Write : std::uint8_t { kNone, kUpdate, kHeartbeat, kDraining };

  // What Step has decided; done once the mutex is released, since gRPC may call back at once.
  struct Decision {
    bool write = false;
    std::optional<grpc::Status> finish = std::nullopt;
    std::optional<Time> wake = std::nullopt;
  };

  Decision Decide(Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Decision DecideFinish(const grpc::Status& status) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Decision DecideWrite(Write what, const grpc::ByteBuffer& bytes, Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Decision DecideStatement(Write what, Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  WatchHub& hub_;
  const JobId job_;
  const std::chrono::nanoseconds interval_;
  const std::function<void()> on_disconnect_;
  const std::function<absl::Status()> may_see_;
  // At first too: what changed before the hub knew this watcher was not noted.
  std::atomic<bool> access_changed_ = true;

  std::mutex mutex_;
  WatchUpdate::Known known_ ABSL_GUARDED_BY(mutex_);
  std::shared_ptr<WatchUpdate> update_ ABSL_GUARDED_BY(mutex_);  // Under way; null between updates.
  std::size_t next_message_ ABSL_GUARDED_BY(mutex_) = 0;
  Write writing_ ABSL_GUARDED_BY(mutex_) = Write::kNone;
  grpc::ByteBuffer bytes_ ABSL_GUARDED_BY(mutex_);  // In flight.
  // Long ago at first, so that a resumed watch without news gets a heartbeat at once and knows that it is connected.
  Time last_write_ ABSL_GUARDED_BY(mutex_);
  Time next_update_ ABSL_GUARDED_BY(mutex_);
  bool said_draining_ ABSL_GUARDED_BY(mutex_) = false;
  bool broken_ ABSL_GUARDED_BY(mutex_) = false;  // The reader has gone.
  bool finished_ ABSL_GUARDED_BY(mutex_) = false;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_WATCHER_H_
