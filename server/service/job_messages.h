// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_JOB_MESSAGES_H_
#define FLATLIGHT_SERVER_SERVICE_JOB_MESSAGES_H_

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "absl/base/thread_annotations.h"
#include "grpcpp/support/slice.h"
#include "server/store/job.h"

namespace flatlight {

// Jobs as they are told, serialised once for each of their states, however often and by however many they are asked
// for. Safe to use from any thread.
class JobMessages {
 public:
  // Of a message that is remembered. Most take about 1 KiB, but a message may have many settings.
  static constexpr std::size_t kMostBytes = 16u << 10;

  // A whole v1::Job, without what only those who may change it are told. A copy of the result shares its bytes. What
  // nobody but the caller has of a job, as it was read from the disk, is not remembered: nobody else will ask for it.
  grpc::Slice Of(const JobRecord& job);
  // Of a job that was deleted.
  void Forget(const JobId& id);

 private:
  // Of a shard. Where there are more, those are forgotten whose states are gone, and if there are none, all.
  static constexpr std::size_t kMostRemembered = 256;

  struct Message {
    std::weak_ptr<const JobState> state;  // That it tells; what states hold is not kept for it.
    grpc::Slice bytes;
  };
  struct Shard {
    std::mutex mutex;
    std::unordered_map<JobId, Message> messages ABSL_GUARDED_BY(mutex);
  };

  Shard& ShardOf(const JobId& id) { return shards_[std::hash<JobId>()(id) % shards_.size()]; }

  std::array<Shard, 16> shards_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_JOB_MESSAGES_H_
