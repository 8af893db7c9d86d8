// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_SERVER_SERVICE_SCENE_CACHE_H_
#define FLATLIGHT_SERVER_SERVICE_SCENE_CACHE_H_

#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "absl/base/thread_annotations.h"
#include "core/scene/scene.h"

namespace flatlight {

// Uploaded scenes that were built not long ago, by the hash of their files: building a large one takes seconds. Each
// reader finds what it has built itself alone: how long a call takes does not tell what others have used.
class SceneCache {
 public:
  // Keeps scenes of at most so many bytes in all, estimated; the one used longest ago goes first.
  explicit SceneCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  // Null if it is not there.
  std::shared_ptr<const Scene> Get(const std::string& reader, const std::string& sha256);
  void Put(const std::string& reader, const std::string& sha256, std::shared_ptr<const Scene> scene);
  // Everybody's.
  void Drop(const std::string& sha256);

  static std::size_t EstimateBytes(const Scene& scene);

 private:
  struct Entry {
    std::string reader;
    std::string sha256;
    std::shared_ptr<const Scene> scene;
    std::size_t bytes;
  };
  using Entries = std::list<Entry>;

  Entries::iterator Find(const std::string& reader, const std::string& sha256) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Moves an entry to `gone`, whose owner frees it without the lock.
  void DropLocked(Entries::iterator entry, Entries& gone) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::size_t max_bytes_;
  std::mutex mutex_;
  Entries entries_ ABSL_GUARDED_BY(mutex_);  // Used last comes first. Few.
  std::size_t bytes_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_SERVICE_SCENE_CACHE_H_
