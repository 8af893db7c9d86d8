// SPDX-License-Identifier: Apache-2.0
#include "core/render/index_cache.h"

#include <algorithm>

namespace flatlight {

std::shared_ptr<const RayCaster> IndexCache::For(const std::shared_ptr<const Scene>& scene,
                                                 const std::string& sharers) {
  if (auto caster = Find(*scene, sharers)) return caster;
  // Without the lock: others need not wait. Two threads may do the same work; either's result is right.
  std::shared_ptr<const RayCaster> caster;
  if (const auto similar = FindSimilar(*scene, sharers)) caster = similar->Refit(scene);
  if (!caster) caster = std::make_shared<const RayCaster>(scene);
  Keep({sharers, caster, nullptr, std::nullopt});
  return caster;
}

std::shared_ptr<const Triangulation> IndexCache::TrianglesFor(const std::shared_ptr<const Scene>& scene,
                                                              const std::string& sharers) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = Position(*scene, sharers);
    // Free points have a part in how well coordinates are known.
    if (found != entries_.end() && found->triangulation &&
        found->triangulation->coordinate_error() == scene->coordinate_error()) {
      return found->triangulation;
    }
    if (found != entries_.end() && found->none == scene->coordinate_error()) return nullptr;
  }
  // Without the lock, as before.
  std::shared_ptr<const Triangulation> triangulation = Triangulation::Of(*scene);
  Entry entry;
  {
    const std::lock_guard lock(mutex_);
    const auto found = Position(*scene, sharers);
    if (found == entries_.end()) return triangulation;
    if (!triangulation) {
      found->none = scene->coordinate_error();
      return nullptr;
    }
    entry = *found;
    entry.triangulation = triangulation;
    if (entry.size() > max_elements_) return triangulation;
    elements_ -= found->size();
    entries_.erase(found);
  }
  Keep(std::move(entry));
  return triangulation;
}

IndexCache::Entries::iterator IndexCache::Position(const Scene& scene, const std::string& sharers) {
  // The world's hash does not tell where free points moved the frame of a world without curves.
  return std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    const Scene& other = entry.caster->scene();
    return entry.sharers == sharers && other.world_hash() == scene.world_hash() &&
           other.elements().size() == scene.elements().size() && !scene.elements().empty();
  });
}

std::shared_ptr<const RayCaster> IndexCache::Find(const Scene& scene, const std::string& sharers) {
  const std::lock_guard lock(mutex_);
  const auto found = Position(scene, sharers);
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return entries_.front().caster;
}

std::shared_ptr<const RayCaster> IndexCache::FindSimilar(const Scene& scene, const std::string& sharers) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.sharers == sharers && entry.caster->scene().elements().size() == scene.elements().size();
  });
  return found == entries_.end() ? nullptr : found->caster;
}

void IndexCache::Keep(Entry entry) {
  const std::size_t size = entry.size();
  if (size > max_elements_) return;
  Entries gone;  // Freed without the lock.
  const std::lock_guard lock(mutex_);
  while (elements_ + size > max_elements_) {
    elements_ -= entries_.back().size();
    gone.splice(gone.begin(), entries_, std::prev(entries_.end()));
  }
  entries_.push_front(std::move(entry));
  elements_ += size;
}

}  // namespace flatlight
