// SPDX-License-Identifier: Apache-2.0
#include "server/service/scene_cache.h"

#include <algorithm>
#include <utility>

namespace flatlight {

std::size_t SceneCache::EstimateBytes(const Scene& scene) {
  return 4096 + scene.elements().size() * sizeof(Element) + scene.curves().size() * sizeof(Curve) +
         scene.traits().probe_points * sizeof(Receiver);
}

std::shared_ptr<const Scene> SceneCache::Get(const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.sha256 == sha256; });
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->scene;
}

void SceneCache::Put(const std::string& sha256, std::shared_ptr<const Scene> scene) {
  const std::size_t bytes = EstimateBytes(*scene);
  if (bytes > max_bytes_) return;
  Entries gone;
  const std::lock_guard lock(mutex_);
  DropLocked(sha256, gone);
  while (bytes_ + bytes > max_bytes_) DropLocked(entries_.back().sha256, gone);
  entries_.push_front({sha256, std::move(scene), bytes});
  bytes_ += bytes;
}

void SceneCache::Drop(const std::string& sha256) {
  Entries gone;
  const std::lock_guard lock(mutex_);
  DropLocked(sha256, gone);
}

void SceneCache::DropLocked(const std::string& sha256, Entries& gone) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.sha256 == sha256; });
  if (found == entries_.end()) return;
  bytes_ -= found->bytes;
  gone.splice(gone.begin(), entries_, found);
}

}  // namespace flatlight
