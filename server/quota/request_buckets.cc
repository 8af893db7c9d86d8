// SPDX-License-Identifier: Apache-2.0
#include "server/quota/request_buckets.h"

#include <algorithm>
#include <chrono>

#include "server/quota/quotas.h"

namespace flatlight {

RequestBuckets::Bucket& RequestBuckets::Filled(Shard& shard, const std::string& user, double a_second) {
  const Clock::Time now = clock_.Now();
  const double capacity = RequestsAtOnce(a_second);
  const auto [entry, is_new] = shard.buckets.try_emplace(user, Bucket{capacity, now});
  Bucket& bucket = entry->second;
  const double seconds = std::chrono::duration<double>(now - bucket.filled).count();
  bucket.left = std::min(capacity, bucket.left + seconds * a_second);
  bucket.filled = now;
  return bucket;
}

std::optional<Clock::Duration> RequestBuckets::Take(const std::string& user, double a_second) {
  Shard& shard = ShardOf(user);
  const std::lock_guard lock(shard.mutex);
  Bucket& bucket = Filled(shard, user, a_second);
  if (bucket.left < 1) {
    return std::chrono::duration_cast<Clock::Duration>(std::chrono::duration<double>((1 - bucket.left) / a_second));
  }
  bucket.left -= 1;
  return std::nullopt;
}

double RequestBuckets::Taken(const std::string& user, double a_second) {
  Shard& shard = ShardOf(user);
  const std::lock_guard lock(shard.mutex);
  return RequestsAtOnce(a_second) - Filled(shard, user, a_second).left;
}

}  // namespace flatlight
