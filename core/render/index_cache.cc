// SPDX-License-Identifier: Apache-2.0
#include "core/render/index_cache.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace flatlight {

std::shared_ptr<const RayCaster> IndexCache::For(const std::shared_ptr<const Scene>& scene) {
  if (auto caster = Find(*scene)) return caster;
  // Without the lock: others need not wait. Two threads may do the same work; either's result is right.
  std::shared_ptr<const RayCaster> caster;
  if (const auto similar = FindSimilar(*scene)) {
    if (std::optional<Bvh> bvh = similar->bvh().Refit(similar->scene(), *scene))
      caster = std::make_shared<const RayCaster>(scene, std::move(*bvh));
  }
  if (!caster) caster = std::make_shared<const RayCaster>(scene);
  Keep(caster);
  return caster;
}

std::shared_ptr<const RayCaster> IndexCache::Find(const Scene& scene) {
  const std::lock_guard lock(mutex_);
  // The world's hash does not tell where free points moved the frame of a world without curves.
  const auto found = std::find_if(casters_.begin(), casters_.end(), [&](const auto& caster) {
    const Scene& other = caster->scene();
    return other.world_hash() == scene.world_hash() && other.elements().size() == scene.elements().size() &&
           !scene.elements().empty();
  });
  if (found == casters_.end()) return nullptr;
  casters_.splice(casters_.begin(), casters_, found);
  return casters_.front();
}

std::shared_ptr<const RayCaster> IndexCache::FindSimilar(const Scene& scene) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(casters_.begin(), casters_.end(), [&](const auto& caster) {
    return caster->scene().elements().size() == scene.elements().size();
  });
  return found == casters_.end() ? nullptr : *found;
}

void IndexCache::Keep(const std::shared_ptr<const RayCaster>& caster) {
  const std::size_t size = caster->scene().elements().size();
  if (size > max_elements_) return;
  Casters gone;  // Freed without the lock.
  const std::lock_guard lock(mutex_);
  while (elements_ + size > max_elements_) {
    elements_ -= casters_.back()->scene().elements().size();
    gone.splice(gone.begin(), casters_, std::prev(casters_.end()));
  }
  casters_.push_front(caster);
  elements_ += size;
}

}  // namespace flatlight
