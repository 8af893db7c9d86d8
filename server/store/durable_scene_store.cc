// SPDX-License-Identifier: Apache-2.0
#include "server/store/durable_scene_store.h"

#include <utility>
#include <vector>

namespace flatlight {

absl::Status DurableSceneStore::Restore() {
  std::vector<std::pair<std::string, std::string>> scenes;  // Hash and title.
  absl::Status listed = storage_.Read([&](Database& database) -> absl::Status {
    Statement rows = database.Prepare("SELECT sha256, title FROM scenes ORDER BY number");
    while (true) {
      const auto row = rows.Step();
      if (!row.ok()) return row.status();
      if (!*row) return absl::OkStatus();
      scenes.emplace_back(rows.Bytes(0), rows.Bytes(1));
    }
  });
  if (!listed.ok()) return listed;
  for (const auto& [sha256, title] : scenes) {
    const auto bytes = storage_.Fetch(sha256);
    // A damaged one is missing; those who name it are told so, and upload it again.
    if (absl::IsDataLoss(bytes.status())) continue;
    if (!bytes.ok()) return bytes.status();
    if (const auto taken = memory_.Upload(sha256, bytes->size(), 0, *bytes); !taken.ok()) return taken.status();
    memory_.SetTitle(sha256, title);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::uint64_t> DurableSceneStore::Upload(const std::string& sha256, std::uint64_t total_bytes,
                                                        std::uint64_t offset, std::string_view data) {
  auto there = memory_.Upload(sha256, total_bytes, offset, data);
  // A mere question has nothing to complete.
  if (!there.ok() || *there < total_bytes || data.empty()) return there;
  const auto scene = memory_.Get(sha256);
  if (!scene.ok()) return there;
  if (absl::Status kept = Keep(*scene); !kept.ok()) {
    memory_.Delete(sha256).IgnoreError();
    return kept;
  }
  return there;
}

absl::Status DurableSceneStore::Keep(const StoredScene& scene) {
  const auto blob = storage_.Prepare(scene.sha256, scene.bytes);
  if (!blob.ok()) return blob.status();
  return storage_.Write([&](Storage::Writing& writing) -> absl::Status {
    Statement there = writing.Prepare("SELECT 1 FROM scenes WHERE sha256 = ?");
    const auto row = there.Bind(std::string_view(scene.sha256)).Step();
    if (!row.ok() || *row) return row.status();
    if (absl::Status used = writing.Use(*blob); !used.ok()) return used;
    Statement insert = writing.Prepare("INSERT INTO scenes(sha256, title, size) VALUES(?, ?, ?)");
    insert.Bind(std::string_view(scene.sha256)).Bind(std::string_view(scene.title));
    return insert.Bind(static_cast<std::int64_t>(scene.bytes->size())).Run();
  });
}

void DurableSceneStore::SetTitle(const std::string& sha256, const std::string& title) {
  const auto before = memory_.Get(sha256);
  if (!before.ok() || before->title == title) return;
  memory_.SetTitle(sha256, title);
  // For people; whoever reads the scene next writes it again.
  storage_
      .Write([&](Storage::Writing& writing) {
        return writing.Prepare("UPDATE scenes SET title = ? WHERE sha256 = ?")
            .Bind(std::string_view(title))
            .Bind(std::string_view(sha256))
            .Run();
      })
      .IgnoreError();
}

absl::Status DurableSceneStore::Delete(const std::string& sha256) {
  absl::Status written = storage_.Write([&](Storage::Writing& writing) -> absl::Status {
    absl::Status removed = writing.Prepare("DELETE FROM scenes WHERE sha256 = ?").Bind(std::string_view(sha256)).Run();
    if (!removed.ok() || writing.database().changed_rows() == 0) return removed;
    return writing.Release(sha256);
  });
  if (!written.ok()) return written;
  return memory_.Delete(sha256);
}

}  // namespace flatlight
