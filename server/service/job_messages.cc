// SPDX-License-Identifier: Apache-2.0
#include "server/service/job_messages.h"

#include "server/service/job_convert.h"
#include "server/service/message_bytes.h"

namespace flatlight {
namespace {

// Of the same object: no later one can be where it was, as long as there is a pointer to it, be it a weak one.
bool IsSame(const std::weak_ptr<const JobState>& a, const std::shared_ptr<const JobState>& b) {
  return !a.owner_before(b) && !b.owner_before(a);
}

}  // namespace

grpc::Slice JobMessages::Of(const JobRecord& job) {
  const JobId& id = job.spec->id;
  Shard& shard = ShardOf(id);
  {
    const std::lock_guard lock(shard.mutex);
    const auto known = shard.messages.find(id);
    if (known != shard.messages.end() && IsSame(known->second.state, job.state)) return known->second.bytes;
  }
  grpc::Slice bytes = ToSlice(JobToProto(*job.spec, *job.state, JobView::kWhole));
  if (bytes.size() > kMostBytes || job.state.use_count() == 1) return bytes;
  const std::lock_guard lock(shard.mutex);
  if (shard.messages.size() >= kMostRemembered) {
    const std::size_t gone =
        std::erase_if(shard.messages, [](const auto& message) { return message.second.state.expired(); });
    if (gone == 0) shard.messages.clear();
  }
  shard.messages.insert_or_assign(id, Message{job.state, bytes});
  return bytes;
}

void JobMessages::Forget(const JobId& id) {
  Shard& shard = ShardOf(id);
  const std::lock_guard lock(shard.mutex);
  shard.messages.erase(id);
}

}  // namespace flatlight
