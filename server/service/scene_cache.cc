// SPDX-License-Identifier: Apache-2.0
#include "server/service/scene_cache.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace flatlight {

std::size_t SceneCache::EstimateBytes(const Scene& scene) {
  return 4096 + scene.elements().size() * sizeof(Element) + scene.curves().size() * sizeof(Curve) +
         scene.traits().probe_points * sizeof(Receiver);
}

SceneCache::Entries::iterator SceneCache::Find(const std::string& reader, const std::string& sha256) {
  return std::find_if(entries_.begin(), entries_.end(),
                      [&](const Entry& entry) { return entry.sha256 == sha256 && entry.reader == reader; });
}

std::shared_ptr<const Scene> SceneCache::Get(const std::string& reader, const std::string& sha256) {
  const std::lock_guard lock(mutex_);
  const auto found = Find(reader, sha256);
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->scene;
}

void SceneCache::Put(const std::string& reader, const std::string& sha256, std::shared_ptr<const Scene> scene) {
  const std::size_t bytes = EstimateBytes(*scene);
  if (bytes > max_bytes_) return;
  Entries gone;
  const std::lock_guard lock(mutex_);
  if (const auto found = Find(reader, sha256); found != entries_.end()) DropLocked(found, gone);
  while (bytes_ + bytes > max_bytes_) DropLocked(std::prev(entries_.end()), gone);
  entries_.push_front({reader, sha256, std::move(scene), bytes});
  bytes_ += bytes;
}

void SceneCache::Drop(const std::string& sha256) {
  Entries gone;
  const std::lock_guard lock(mutex_);
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const auto next = std::next(entry);
    if (entry->sha256 == sha256) DropLocked(entry, gone);
    entry = next;
  }
}

void SceneCache::DropLocked(Entries::iterator entry, Entries& gone) {
  bytes_ -= entry->bytes;
  gone.splice(gone.begin(), entries_, entry);
}

}  // namespace flatlight
