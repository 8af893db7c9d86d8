// SPDX-License-Identifier: Apache-2.0
#include "core/render/solved_worlds.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace flatlight {

SolvedWorlds::Entries::iterator SolvedWorlds::Position(const Scene& scene, std::size_t channels,
                                                       std::optional<std::uint32_t> max_bounces,
                                                       const std::string& sharers) {
  // The world's hash does not tell where free points moved the frame of a world without curves.
  return std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    const Scene& other = entry.world->caster->scene();
    return entry.sharers == sharers && other.world_hash() == scene.world_hash() &&
           other.elements().size() == scene.elements().size() && !scene.elements().empty() &&
           entry.world->channels == channels && entry.world->max_bounces == max_bounces;
  });
}

std::unique_ptr<SolvedWorld> SolvedWorlds::Take(const Scene& scene, std::size_t channels,
                                                std::optional<std::uint32_t> max_bounces, const std::string& sharers) {
  const std::lock_guard lock(mutex_);
  const auto found = Position(scene, channels, max_bounces, sharers);
  if (found == entries_.end()) return nullptr;
  std::unique_ptr<SolvedWorld> world = std::move(found->world);
  bytes_ -= found->bytes;
  entries_.erase(found);
  return world;
}

void SolvedWorlds::Keep(std::unique_ptr<SolvedWorld> world, const std::string& sharers) {
  std::size_t bytes = world->bytes();
  if (bytes > max_bytes_) {
    world->radiosity->DropRows();
    bytes = world->bytes();
  }
  if (bytes > max_bytes_) return;
  Entries gone;  // Freed without the lock.
  const std::lock_guard lock(mutex_);
  const auto same = Position(world->caster->scene(), world->channels, world->max_bounces, sharers);
  if (same != entries_.end()) {
    if (same->world->radiosity->mesh().size() > world->radiosity->mesh().size()) return;
    bytes_ -= same->bytes;
    gone.splice(gone.begin(), entries_, same);
  }
  while (bytes_ + bytes > max_bytes_) {
    bytes_ -= entries_.back().bytes;
    gone.splice(gone.begin(), entries_, std::prev(entries_.end()));
  }
  entries_.push_front({std::move(world), bytes, sharers});
  bytes_ += bytes;
}

}  // namespace flatlight
