// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_INDEX_CACHE_H_
#define FLATLIGHT_CORE_RENDER_INDEX_CACHE_H_

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/plane/ray_caster.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/render/solved_worlds.h"
#include "core/scene/scene.h"

namespace flatlight {

// Ray casters and triangulations of the scenes used last, so that jobs on one world share them, and an edited world
// gets the caster before it refitted; and what is solved of worlds. Shared only by those who are asked for under the
// same name of `sharers`: how long a job takes tells nothing of what others have rendered. Safe to use from several
// threads.
class IndexCache {
 public:
  // Keeps casters of scenes of at most so many elements in all, triangulations counted by their memory as elements of
  // kElementBytes each; what was used longest ago goes first. `max_solved_bytes`: of solved worlds.
  explicit IndexCache(std::size_t max_elements, std::size_t max_solved_bytes = 0)
      : max_elements_(max_elements), solved_(std::make_shared<SolvedWorlds>(max_solved_bytes)) {}

  // A caster whose scene has the world of `scene`: the same curves, elements and coordinates.
  std::shared_ptr<const RayCaster> For(const std::shared_ptr<const Scene>& scene, const std::string& sharers = "");

  // A triangulation of the scene's world; null where there can be none (see Triangulation::Of).
  std::shared_ptr<const Triangulation> TrianglesFor(const std::shared_ptr<const Scene>& scene,
                                                    const std::string& sharers = "");

  const std::shared_ptr<SolvedWorlds>& solved_worlds() const { return solved_; }

  static constexpr std::size_t kElementBytes = 300;  // Of a caster with its scene.

 private:
  struct Entry {
    std::string sharers;
    std::shared_ptr<const RayCaster> caster;
    std::shared_ptr<const Triangulation> triangulation;  // Made when it is first wanted.
    std::optional<double> none;  // The coordinates' accuracy with which there can be no triangulation.

    std::size_t size() const {
      return caster->scene().elements().size() + (triangulation ? triangulation->bytes() / kElementBytes : 0);
    }
  };
  using Entries = std::list<Entry>;

  std::shared_ptr<const RayCaster> Find(const Scene& scene, const std::string& sharers);
  Entries::iterator Position(const Scene& scene, const std::string& sharers);  // With the lock.
  // The caster used last that an edit could have led from; null if there is none.
  std::shared_ptr<const RayCaster> FindSimilar(const Scene& scene, const std::string& sharers);
  void Keep(Entry entry);

  const std::size_t max_elements_;
  const std::shared_ptr<SolvedWorlds> solved_;
  std::mutex mutex_;
  Entries entries_;           // Used last comes first; few. Guarded by mutex_.
  std::size_t elements_ = 0;  // As counted.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_INDEX_CACHE_H_
