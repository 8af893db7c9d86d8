// SPDX-License-Identifier: Apache-2.0
#include "server/scheduler/job_checkpoint.h"

#include <limits>

#include "core/render/state_stream.h"

namespace flatlight {
namespace {

constexpr std::uint64_t kFormat = 0x31'70'6b'63'74'68'6c'66;  // "flhtckp1".

template <class Checkpoint, class Stream>
void State(Checkpoint& checkpoint, Stream& stream) {
  stream(checkpoint.job_key, checkpoint.elapsed_seconds, checkpoint.cpu_seconds, checkpoint.start_time,
         checkpoint.rendering);
}

}  // namespace

std::string WriteJobCheckpoint(const JobCheckpoint& checkpoint) {
  StateWriter writer(std::numeric_limits<std::size_t>::max());
  writer(kFormat);
  State(checkpoint, writer);
  return writer.Take();
}

std::optional<JobCheckpoint> ReadJobCheckpoint(std::string_view bytes) {
  StateReader reader(bytes);
  std::uint64_t format = 0;
  reader(format);
  reader.Require(format == kFormat);
  JobCheckpoint checkpoint;
  State(checkpoint, reader);
  if (!reader.AtEnd()) return std::nullopt;
  return checkpoint;
}

}  // namespace flatlight
