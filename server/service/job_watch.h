// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_JOB_WATCH_H_
#define FLATLIGHT_SERVER_SERVICE_JOB_WATCH_H_

#include <chrono>
#include <memory>

#include "server/service/watch.h"
#include "server/service/watch_update.h"

namespace flatlight {

// A WatchJob stream.
class JobWatch final : public Watch {
 public:
  // `known`: what the reader has already. Updates begin at least `interval` apart, except the last one.
  JobWatch(WatchHub& hub, const JobId& job, WatchUpdate::Known known, std::chrono::nanoseconds interval, Hooks hooks)
      : Watch(hub, job.Name(), std::move(hooks)), job_(job), interval_(interval), known_(known) {}

 private:
  Decision DecideNext(Time now) override ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Decision DecideWhileWriting(Time now) override ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void NoteWritten() override ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void NoteFinish() override ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { update_.reset(); }
  grpc::ByteBuffer Statement(bool draining) const override ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Decision DecideUpdate(Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const JobId job_;
  const std::chrono::nanoseconds interval_;
  WatchUpdate::Known known_ ABSL_GUARDED_BY(mutex_);
  std::shared_ptr<WatchUpdate> update_ ABSL_GUARDED_BY(mutex_);  // Under way; null between updates.
  std::size_t next_message_ ABSL_GUARDED_BY(mutex_) = 0;
  Time next_update_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_JOB_WATCH_H_
