// SPDX-License-Identifier: Apache-2.0
#include "server/store/durable_scene_store.h"

#include <utility>
#include <vector>

#include "server/store/grant_table.h"

namespace flatlight {

namespace {

using Writing = Storage::Writing;

// Of an owner's shares of a scene, in the table of grants.
std::string ResourceOf(const std::string& owner, const std::string& sha256) {
  return "scenes/" + sha256 + "/owners/" + owner;
}

absl::Status Remove(Writing& writing, const std::string& sha256) {
  absl::Status removed = writing.Prepare("DELETE FROM scenes WHERE sha256 = ?").Bind(std::string_view(sha256)).Run();
  if (!removed.ok() || writing.database().changed_rows() == 0) return removed;
  return writing.Release(sha256);
}

}  // namespace

absl::Status DurableSceneStore::Restore() {
  if (absl::Status restored = RestoreScenes(); !restored.ok()) return restored;
  return RestoreOwners();
}

absl::Status DurableSceneStore::RestoreScenes() {
  std::vector<std::pair<std::string, std::string>> scenes;  // Hash and title.
  absl::Status listed = storage_.Read([&](Database& database) -> absl::Status {
    return database.Prepare("SELECT sha256, title FROM scenes ORDER BY number").ForEachRow([&](const Statement& row) {
      scenes.emplace_back(row.Bytes(0), row.Bytes(1));
    });
  });
  if (!listed.ok()) return listed;
  for (auto& [sha256, title] : scenes) {
    auto bytes = storage_.Fetch(sha256);
    // A damaged one is missing; those who name it are told so, and upload it again.
    if (absl::IsDataLoss(bytes.status())) continue;
    if (!bytes.ok()) return bytes.status();
    memory_.Add({sha256, std::move(title), std::make_shared<const std::string>(*std::move(bytes))});
  }
  return absl::OkStatus();
}

absl::Status DurableSceneStore::RestoreOwners() {
  return storage_.Read([&](Database& database) -> absl::Status {
    Statement rows = database.Prepare("SELECT owner, sha256, title FROM scene_owners ORDER BY number");
    while (true) {
      const auto row = rows.Step();
      if (!row.ok()) return row.status();
      if (!*row) return absl::OkStatus();
      const std::string owner = rows.Bytes(0), sha256 = rows.Bytes(1);
      memory_.AddOwner(owner, sha256, rows.Bytes(2));
      const auto grants = ReadGrants(database, ResourceOf(owner, sha256));
      if (!grants.ok()) return grants.status();
      for (const Grant& grant : *grants)
        memory_.Share(owner, sha256, grant).IgnoreError();  // A damaged one is missing.
    }
  });
}

absl::StatusOr<std::uint64_t> DurableSceneStore::Upload(const std::string& owner, const std::string& sha256,
                                                        std::uint64_t total_bytes, std::uint64_t offset,
                                                        std::string_view data, const std::optional<SceneRoom>& room) {
  auto there = memory_.Upload(owner, sha256, total_bytes, offset, data, room);
  // A mere question has nothing to complete.
  if (!there.ok() || *there < total_bytes || data.empty()) return there;
  const auto scene = memory_.Get(sha256);
  if (!scene.ok()) return there;
  if (absl::Status kept = Keep(owner, *scene); !kept.ok()) {
    memory_.Disown(owner, sha256).IgnoreError();
    return kept;
  }
  return there;
}

absl::Status DurableSceneStore::Keep(const std::string& owner, const StoredScene& scene) {
  // Whether another one has it must not be told by the time that this takes.
  const auto blob = storage_.Prepare(scene.sha256, scene.bytes, BlobFiles::IfThere::kReplace);
  if (!blob.ok()) return blob.status();
  return storage_.Write([&](Writing& writing) -> absl::Status {
    Statement there = writing.Prepare("SELECT 1 FROM scenes WHERE sha256 = ?");
    const auto row = there.Bind(std::string_view(scene.sha256)).Step();
    if (!row.ok()) return row.status();
    if (!*row) {
      if (absl::Status used = writing.Use(*blob); !used.ok()) return used;
      Statement insert = writing.Prepare("INSERT INTO scenes(sha256, title, size) VALUES(?, ?, ?)");
      insert.Bind(std::string_view(scene.sha256)).Bind(std::string_view(scene.title));
      insert.Bind(static_cast<std::int64_t>(scene.bytes->size()));
      if (absl::Status inserted = insert.Run(); !inserted.ok()) return inserted;
    } else if (absl::Status rewritten = writing.Rewrite(*blob); !rewritten.ok()) {
      return rewritten;
    }
    return writing.Prepare("INSERT OR IGNORE INTO scene_owners(owner, sha256, title) VALUES(?, ?, '')")
        .Bind(std::string_view(owner))
        .Bind(std::string_view(scene.sha256))
        .Run();
  });
}

bool DurableSceneStore::SetTitle(const std::string& reader, const std::string& sha256, const std::string& title) {
  if (!memory_.SetTitle(reader, sha256, title)) return false;
  // For people; if it cannot be written now, whoever reads the scene after a restart writes it.
  storage_
      .Write([&](Writing& writing) -> absl::Status {
        absl::Status titled = writing.Prepare("UPDATE scenes SET title = ? WHERE sha256 = ?")
                                  .Bind(std::string_view(title))
                                  .Bind(std::string_view(sha256))
                                  .Run();
        if (!titled.ok()) return titled;
        return writing.Prepare("UPDATE scene_owners SET title = ? WHERE owner = ? AND sha256 = ?")
            .Bind(std::string_view(title))
            .Bind(std::string_view(reader))
            .Bind(std::string_view(sha256))
            .Run();
      })
      .IgnoreError();
  return true;
}

// What cannot be written has not happened.
absl::Status DurableSceneStore::Share(const std::string& owner, const std::string& sha256, const Grant& grant) {
  const std::lock_guard lock(sharing_);
  absl::Status written = storage_.Write([&](Writing& writing) -> absl::Status {
    if (!memory_.Owns(owner, sha256)) return NoSuchScene(sha256);
    return InsertGrant(writing.database(), ResourceOf(owner, sha256), grant);
  });
  return written.ok() ? memory_.Share(owner, sha256, grant) : written;
}

absl::Status DurableSceneStore::Unshare(const std::string& owner, const std::string& sha256, const Grantee& grantee) {
  const std::lock_guard lock(sharing_);
  absl::Status written = storage_.Write([&](Writing& writing) -> absl::Status {
    if (!memory_.Owns(owner, sha256)) return NoSuchScene(sha256);
    return DeleteGrant(writing.database(), ResourceOf(owner, sha256), grantee);
  });
  return written.ok() ? memory_.Unshare(owner, sha256, grantee) : written;
}

absl::Status DurableSceneStore::Disown(const std::string& owner, const std::string& sha256) {
  const std::lock_guard lock(sharing_);
  absl::Status written = storage_.Write([&](Writing& writing) -> absl::Status {
    absl::Status disowned = writing.Prepare("DELETE FROM scene_owners WHERE owner = ? AND sha256 = ?")
                                .Bind(std::string_view(owner))
                                .Bind(std::string_view(sha256))
                                .Run();
    if (!disowned.ok() || writing.database().changed_rows() == 0) return disowned;
    Statement others = writing.Prepare("SELECT 1 FROM scene_owners WHERE sha256 = ?");
    const auto row = others.Bind(std::string_view(sha256)).Step();
    if (!row.ok() || *row) return row.status();
    return Remove(writing, sha256);
  });
  if (!written.ok()) return written;
  return memory_.Disown(owner, sha256);
}

absl::Status DurableSceneStore::Delete(const std::string& sha256) {
  const std::lock_guard lock(sharing_);
  absl::Status written = storage_.Write([&](Writing& writing) -> absl::Status {
    absl::Status disowned =
        writing.Prepare("DELETE FROM scene_owners WHERE sha256 = ?").Bind(std::string_view(sha256)).Run();
    if (!disowned.ok()) return disowned;
    return Remove(writing, sha256);
  });
  if (!written.ok()) return written;
  return memory_.Delete(sha256);
}

}  // namespace flatlight
