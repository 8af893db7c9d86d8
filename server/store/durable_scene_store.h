// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_DURABLE_SCENE_STORE_H_
#define FLATLIGHT_SERVER_STORE_DURABLE_SCENE_STORE_H_

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "server/store/memory_scene_store.h"
#include "server/store/storage.h"

namespace flatlight {

// Scenes that outlive the process: held in memory, and written when they are complete. Unfinished uploads begin anew.
class DurableSceneStore final : public SceneStore {
 public:
  DurableSceneStore(const MemorySceneStore::Limits& limits, const Clock& clock, Storage& storage)
      : memory_(limits, clock), storage_(storage) {}

  // Reads the scenes of the process before. To be called once, first.
  absl::Status Restore();

  using SceneStore::Upload;
  absl::StatusOr<std::uint64_t> Upload(const std::string& owner, const std::string& sha256, std::uint64_t total_bytes,
                                       std::uint64_t offset, std::string_view data,
                                       const std::optional<SceneRoom>& room) override;
  std::uint64_t BytesOf(const std::string& owner) override { return memory_.BytesOf(owner); }
  absl::StatusOr<StoredScene> Get(const std::string& sha256) override { return memory_.Get(sha256); }
  bool Owns(const std::string& owner, const std::string& sha256) override { return memory_.Owns(owner, sha256); }
  bool SetTitle(const std::string& reader, const std::string& sha256, const std::string& title) override;
  ScenePage List(const std::optional<std::string>& owner, std::optional<std::uint64_t> before,
                 std::size_t limit) override {
    return memory_.List(owner, before, limit);
  }
  ScenePage ListShared(const std::vector<Grantee>& who, const std::string& reader, std::optional<std::uint64_t> before,
                       std::size_t limit) override {
    return memory_.ListShared(who, reader, before, limit);
  }
  std::vector<std::string> OwnersOf(const std::string& sha256) override { return memory_.OwnersOf(sha256); }
  absl::Status Share(const std::string& owner, const std::string& sha256, const Grant& grant) override;
  absl::Status Unshare(const std::string& owner, const std::string& sha256, const Grantee& grantee) override;
  std::vector<Grant> GrantsOf(const std::string& owner, const std::string& sha256) override {
    return memory_.GrantsOf(owner, sha256);
  }
  std::map<std::string, Access> SharedBy(const std::string& sha256, const std::vector<Grantee>& who) override {
    return memory_.SharedBy(sha256, who);
  }
  absl::Status Disown(const std::string& owner, const std::string& sha256) override;
  absl::Status Delete(const std::string& sha256) override;

 private:
  absl::Status RestoreScenes();
  absl::Status RestoreOwners();
  absl::Status Keep(const std::string& owner, const StoredScene& scene);

  std::mutex sharing_;  // Held while shares change, and what they depend on: in memory as on disk.
  MemorySceneStore memory_;
  Storage& storage_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_DURABLE_SCENE_STORE_H_
