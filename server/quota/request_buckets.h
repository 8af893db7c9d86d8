// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_QUOTA_REQUEST_BUCKETS_H_
#define FLATLIGHT_SERVER_QUOTA_REQUEST_BUCKETS_H_

#include <array>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "absl/base/thread_annotations.h"
#include "core/execution/clock.h"

namespace flatlight {

// A token bucket for each user. Every call asks, from any thread: it is in memory alone, with a lock that few share.
class RequestBuckets {
 public:
  // `clock` outlives this.
  explicit RequestBuckets(const Clock& clock) : clock_(clock) {}

  // Takes a request out of the user's bucket, which holds RequestsAtOnce and gets `a_second` new ones. If there
  // is none, how long until there is one; being refused costs nothing.
  std::optional<Clock::Duration> Take(const std::string& user, double a_second);
  // How many of the bucket's requests are out.
  double Taken(const std::string& user, double a_second);

 private:
  struct Bucket {
    double left = 0;
    Clock::Time filled;
  };
  struct Shard {
    std::mutex mutex;
    std::unordered_map<std::string, Bucket> buckets ABSL_GUARDED_BY(mutex);
  };

  Shard& ShardOf(const std::string& user) { return shards_[std::hash<std::string>()(user) % shards_.size()]; }
  Bucket& Filled(Shard& shard, const std::string& user, double a_second) ABSL_EXCLUSIVE_LOCKS_REQUIRED(shard.mutex);

  const Clock& clock_;
  std::array<Shard, 16> shards_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_QUOTA_REQUEST_BUCKETS_H_
