// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_WATCH_UPDATE_H_
#define FLATLIGHT_SERVER_SERVICE_WATCH_UPDATE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "flatlight/v1/render_service.pb.h"
#include "grpcpp/support/byte_buffer.h"
#include "server/store/job.h"

namespace flatlight {

// The messages that bring a watcher from what it knows to one state of a job. Each is serialised at most once, when it
// is first wanted, and shared by all watchers on the same way.
class WatchUpdate {
 public:
  // What a watcher knows: nothing (absent), or the state of a sequence.
  using Known = std::optional<std::uint64_t>;

  // Messages are at most about this long.
  static constexpr std::size_t kMaxMessageBytes = 512u << 10;

  WatchUpdate(JobRecord job, std::uint64_t epoch, Known known);

  // Whether these are the messages that a watcher of that knowledge needs to get to `state`.
  bool LeadsTo(const JobState& state, Known known) const {
    return state.sequence == job_.state->sequence && Canonical(state, known) == known_;
  }
  const JobState& state() const { return *job_.state; }
  std::size_t size() const { return contents_.size(); }  // At least 1.
  grpc::ByteBuffer Message(std::size_t index);
  // Unserialised, for tests and for Message.
  v1::WatchJobResponse Build(std::size_t index) const;

 private:
  // Equal for all knowledge that needs the same messages to get to `state`.
  static Known Canonical(const JobState& state, Known known);

  // Points [first, first + count) of a probe.
  struct Cut {
    std::size_t probe = 0;
    std::size_t first = 0;
    std::size_t count = 0;
  };

  // Records [first, first + count) of the log, or their radii alone.
  struct RecordCut {
    std::size_t first = 0;
    std::size_t count = 0;
    bool radii_alone = false;
  };
  struct Content {
    std::vector<Cut> points;
    std::vector<RecordCut> records;
  };

  void PlanMessages();
  void PlanPoints();
  void PlanRecords();
  // Begins another message.
  void TurnPage();

  const JobRecord job_;
  const std::uint64_t epoch_;
  const Known known_;
  std::vector<Content> contents_;  // Of each message.
  std::size_t room_ = 0;           // In the last one, while they are planned. Bytes.
  std::mutex mutex_;
  std::vector<std::optional<grpc::ByteBuffer>> messages_ ABSL_GUARDED_BY(mutex_);
};

// A message that says only how far the watcher is.
v1::WatchJobResponse Heartbeat(std::uint64_t epoch, std::uint64_t sequence);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_WATCH_UPDATE_H_
