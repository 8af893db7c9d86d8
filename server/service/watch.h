// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_WATCH_H_
#define FLATLIGHT_SERVER_SERVICE_WATCH_H_

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "grpcpp/support/server_callback.h"
#include "server/service/watch_hub.h"

namespace flatlight {

// One stream of somebody who watches something: a cursor into its state, which the one who derives has, and at most one
// write in flight. A slow reader gets fewer, newer messages; nothing queues up.
class Watch : public grpc::ServerWriteReactor<grpc::ByteBuffer>, public std::enable_shared_from_this<Watch> {
 public:
  using Time = WatchHub::Time;

  struct Hooks {
    std::string watcher = {};  // Who watches.
    // Is called at most once: when the reader goes while the server is up. May be empty.
    std::function<void()> on_disconnect = nullptr;
    // Says, at the beginning and after NoteAccessChange, with what error the watch ends. Empty: with none.
    std::function<absl::Status()> may_see = nullptr;
    // The same, after NoteUsersChange: of who watches, whatever is watched.
    std::function<absl::Status()> is_known = nullptr;
  };

  // Writes, finishes or waits, as what is watched, the reader and the clock ask for. May be called at any time.
  void Step();
  // Heeded by the next step.
  void NoteAccessChange() { access_changed_ = true; }
  void NoteUsersChange() { users_changed_ = true; }

  const std::string& watcher() const { return hooks_.watcher; }

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

  // The hub's, guarded by its mutex.
  std::optional<Time> wake_time;
  bool removed = false;

 protected:
  // What Step has decided; done once the mutex is released, since gRPC may call back at once.
  struct Decision {
    bool write = false;
    std::optional<grpc::Status> finish = std::nullopt;
    std::optional<Time> wake = std::nullopt;
  };

  // `subject` names what is watched: "jobs/{uuid}".
  Watch(WatchHub& hub, std::string subject, Hooks hooks)
      : hub_(hub), subject_(std::move(subject)), hooks_(std::move(hooks)) {}

  // What to do next, while nothing is being written and the watch goes on.
  virtual Decision DecideNext(Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) = 0;
  // What to do while a message of DecideWrite is being written.
  virtual Decision DecideWhileWriting(Time /*now*/) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return {}; }
  // A message of DecideWrite has been taken.
  virtual void NoteWritten() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) = 0;
  // The watch ends.
  virtual void NoteFinish() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {}
  // A message without news.
  virtual grpc::ByteBuffer Statement(bool draining) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) = 0;

  Decision DecideFinish(const grpc::Status& status) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Decision DecideWrite(const grpc::ByteBuffer& bytes, Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // A heartbeat if it is time for one, else nothing until then, or until `wake`.
  Decision DecideHeartbeat(Time now, std::optional<Time> wake = std::nullopt) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  WatchHub& hub_;
  std::mutex mutex_;
  // Long ago at first, so that a resumed watch without news gets a heartbeat at once and knows that it is connected.
  Time last_write_ ABSL_GUARDED_BY(mutex_);

 private:
  enum class Write : std::uint8_t { kNone, kNews, kStatement };
  Decision Decide(Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // With what error the watch is to end.
  absl::Status CheckWatcher();
  Decision DecideStatement(bool draining, Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::string subject_;
  const Hooks hooks_;
  // At first too: what changed before the hub knew this watch was not noted.
  std::atomic<bool> access_changed_ = true;
  std::atomic<bool> users_changed_ = true;
  Write writing_ ABSL_GUARDED_BY(mutex_) = Write::kNone;
  grpc::ByteBuffer bytes_ ABSL_GUARDED_BY(mutex_);  // In flight.
  bool said_draining_ ABSL_GUARDED_BY(mutex_) = false;
  bool broken_ ABSL_GUARDED_BY(mutex_) = false;  // The reader has gone.
  bool finished_ ABSL_GUARDED_BY(mutex_) = false;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_WATCH_H_
