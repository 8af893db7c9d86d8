// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_STORE_MEMORY_SCENE_STORE_H_
#define FLATLIGHT_SERVER_STORE_MEMORY_SCENE_STORE_H_

#include <map>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "core/execution/clock.h"
#include "server/store/scene_store.h"
#include "server/store/sha256.h"

namespace flatlight {

// Scenes that live as long as the process.
class MemorySceneStore final : public SceneStore {
 public:
  struct Limits {
    std::uint64_t max_scene_bytes = 512ull << 20;
    std::uint64_t max_total_bytes = 2ull << 30;  // Of scenes and unfinished uploads.
    std::size_t max_scenes = 10'000;
    std::size_t max_uploads = 256;  // Unfinished. The one that has been idle longest gives way, if idle for a minute.
  };
  MemorySceneStore(const Limits& limits, const Clock& clock) : limits_(limits), clock_(clock) {}

  using SceneStore::Upload;
  absl::StatusOr<std::uint64_t> Upload(const std::string& owner, const std::string& sha256, std::uint64_t total_bytes,
                                       std::uint64_t offset, std::string_view data,
                                       const std::optional<SceneRoom>& room) override;
  std::uint64_t BytesOf(const std::string& owner) override;
  absl::StatusOr<StoredScene> Get(const std::string& sha256) override;
  bool Owns(const std::string& owner, const std::string& sha256) override;
  bool SetTitle(const std::string& reader, const std::string& sha256, const std::string& title) override;
  ScenePage List(const std::optional<std::string>& owner, std::optional<std::uint64_t> before,
                 std::size_t limit) override;
  ScenePage ListShared(const std::vector<Grantee>& who, const std::string& reader, std::optional<std::uint64_t> before,
                       std::size_t limit) override;
  std::vector<std::string> OwnersOf(const std::string& sha256) override;
  absl::Status Share(const std::string& owner, const std::string& sha256, const Grant& grant) override;
  absl::Status Unshare(const std::string& owner, const std::string& sha256, const Grantee& grantee) override;
  std::vector<Grant> GrantsOf(const std::string& owner, const std::string& sha256) override;
  std::map<std::string, Access> SharedBy(const std::string& sha256, const std::vector<Grantee>& who) override;
  absl::Status Disown(const std::string& owner, const std::string& sha256) override;
  absl::Status Delete(const std::string& sha256) override;

  // For a store that outlives the process: a scene of the process before, whatever the limits, and an owner of one.
  void Add(StoredScene scene);
  void AddOwner(const std::string& owner, const std::string& sha256, const std::string& title);

 private:
  struct PartialUpload {
    std::mutex mutex;  // Held while bytes are copied and hashed. Taken before the store's mutex, never after.
    std::uint64_t total_bytes = 0;
    std::shared_ptr<std::string> bytes = std::make_shared<std::string>();
    Sha256 hash;
    bool closed = false;  // Completed or thrown away.
    Clock::Time last_use;
  };

  using UploadName = std::pair<std::string, std::string>;  // Owner and hash: nobody sees how far another one is.
  struct Ownership {
    std::uint64_t number = 0;  // Of the scene among those of its owner.
    std::vector<Grant> grants = {};
  };
  struct Entry {
    StoredScene scene;
    std::map<std::string, Ownership> owners;
  };
  struct Owned {
    std::string sha256;
    std::string title;  // Empty until the owner has read the file.
  };

  absl::StatusOr<std::shared_ptr<PartialUpload>> OpenUpload(const UploadName& name, std::uint64_t total_bytes,
                                                            const std::optional<SceneRoom>& room)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Of an owner's own room: whether `bytes` more of an upload fit, once its idle ones have given way.
  absl::Status CheckRoom(const UploadName& name, const SceneRoom& room, std::uint64_t bytes)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Throws an unfinished upload away, unless it is in use.
  bool GiveWay(std::map<UploadName, std::shared_ptr<PartialUpload>>::iterator upload)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::Status Reserve(const UploadName& name, const std::optional<SceneRoom>& room, std::uint64_t bytes);
  void AddBytes(const std::string& owner, std::uint64_t bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void TakeBytes(const std::string& owner, std::uint64_t bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  absl::StatusOr<std::uint64_t> Complete(const UploadName& name, PartialUpload& upload);
  Entry* Find(const std::string& sha256) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Ownership* FindOwnership(const std::string& owner, const std::string& sha256) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void AddLocked(StoredScene scene) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void AddOwnerLocked(const std::string& owner, const std::string& sha256, const std::string& title)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void ForgetOwned(const std::string& owner, std::uint64_t number) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Erase(const std::string& sha256) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const Limits limits_;
  const Clock& clock_;
  std::mutex mutex_;
  std::uint64_t next_number_ ABSL_GUARDED_BY(mutex_) = 1;
  std::uint64_t used_bytes_ ABSL_GUARDED_BY(mutex_) = 0;
  std::map<std::uint64_t, Entry> scenes_ ABSL_GUARDED_BY(mutex_);  // By number: in order of completion.
  std::unordered_map<std::string, std::uint64_t> numbers_ ABSL_GUARDED_BY(mutex_);
  std::unordered_map<std::string, std::map<std::uint64_t, Owned>> owned_
      ABSL_GUARDED_BY(mutex_);  // The same, by owner.
  std::map<UploadName, std::shared_ptr<PartialUpload>> uploads_ ABSL_GUARDED_BY(mutex_);
  std::unordered_map<std::string, std::uint64_t> bytes_of_ ABSL_GUARDED_BY(mutex_);  // By owner; none of 0.
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_STORE_MEMORY_SCENE_STORE_H_
