// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_SOLVED_WORLDS_H_
#define FLATLIGHT_CORE_RENDER_SOLVED_WORLDS_H_

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/plane/reference/solved_world.h"
#include "core/scene/scene.h"

namespace flatlight {

// What `reference` found about the worlds used last, so that other probes are gathered from what is solved and a
// smaller target refines it. Apart for each name of `sharers`, as in IndexCache. Who takes one has it alone: another
// job on that world begins anew meanwhile. Safe to use from several threads.
class SolvedWorlds {
 public:
  // Keeps so many bytes; what was used longest ago goes first. Of what is too large by itself the light alone is kept,
  // without what a finer solution would save by it.
  explicit SolvedWorlds(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  // Of the scene's world, solved for so many channels and bounces; null if there is none.
  std::unique_ptr<SolvedWorld> Take(const Scene& scene, std::size_t channels, std::optional<std::uint32_t> max_bounces,
                                    const std::string& sharers = "");
  // Of two of one world the finer one stays.
  void Keep(std::unique_ptr<SolvedWorld> world, const std::string& sharers = "");

 private:
  struct Entry {
    std::unique_ptr<SolvedWorld> world;
    std::size_t bytes = 0;
    std::string sharers;
  };
  using Entries = std::list<Entry>;
  Entries::iterator Position(const Scene& scene, std::size_t channels, std::optional<std::uint32_t> max_bounces,
                             const std::string& sharers);

  const std::size_t max_bytes_;
  std::mutex mutex_;
  Entries entries_;  // Used last comes first; few. Guarded by mutex_.
  std::size_t bytes_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_SOLVED_WORLDS_H_
