// SPDX-License-Identifier: Apache-2.0
#include "server/store/stored_bytes.h"

#include <optional>
#include <vector>

namespace flatlight {
namespace {

struct Unmeasured {
  std::int64_t number = 0;
  std::string request;
  std::optional<std::string> result;
};

absl::Status MeasureOld(Storage& storage) {
  std::vector<Unmeasured> jobs;
  absl::Status listed = storage.Read([&](Database& database) -> absl::Status {
    return database.Prepare("SELECT number, request, result FROM jobs WHERE stored_bytes IS NULL")
        .ForEachRow([&](const Statement& row) {
          jobs.push_back({row.Integer(0), row.Bytes(1), row.OptionalBytes(2)});
        });
  });
  if (!listed.ok() || jobs.empty()) return listed;
  std::vector<std::uint64_t> sizes;
  sizes.reserve(jobs.size());
  for (const Unmeasured& job : jobs) {
    sizes.push_back(storage.SizeOf(job.request) + (job.result ? storage.SizeOf(*job.result) : 0));
  }
  return storage.Write([&](Storage::Writing& writing) -> absl::Status {
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      absl::Status measured = writing.Prepare("UPDATE jobs SET stored_bytes = ? WHERE number = ?")
                                  .Bind(static_cast<std::int64_t>(sizes[i]))
                                  .Bind(jobs[i].number)
                                  .Run();
      if (!measured.ok()) return measured;
    }
    return absl::OkStatus();
  });
}

}  // namespace

StoredBytes MeasureStoredBytes(Storage& storage) {
  // Where it cannot be written it is measured by the next process.
  MeasureOld(storage).IgnoreError();
  StoredBytes stored;
  storage
      .Read([&](Database& database) -> absl::Status {
        return database.Prepare("SELECT owner, total(stored_bytes) FROM jobs GROUP BY owner")
            .ForEachRow([&](const Statement& row) { stored[row.Bytes(0)] = static_cast<std::int64_t>(row.Real(1)); });
      })
      .IgnoreError();
  return stored;
}

}  // namespace flatlight
