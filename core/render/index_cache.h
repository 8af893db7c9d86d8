// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_INDEX_CACHE_H_
#define FLATLIGHT_CORE_RENDER_INDEX_CACHE_H_

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

#include "core/plane/ray_caster.h"
#include "core/scene/scene.h"

namespace flatlight {

// Ray casters of the scenes used last, so that jobs on one world share an index, and an edited world gets the one
// before it refitted. Safe to use from several threads.
class IndexCache {
 public:
  // Keeps casters of scenes of at most so many elements in all; the one used longest ago goes first.
  explicit IndexCache(std::size_t max_elements) : max_elements_(max_elements) {}

  // A caster whose scene has the world of `scene`: the same curves, elements and coordinates.
  std::shared_ptr<const RayCaster> For(const std::shared_ptr<const Scene>& scene);

 private:
  using Casters = std::list<std::shared_ptr<const RayCaster>>;

  std::shared_ptr<const RayCaster> Find(const Scene& scene);
  // The caster used last that an edit could have led from; null if there is none.
  std::shared_ptr<const RayCaster> FindSimilar(const Scene& scene);
  void Keep(const std::shared_ptr<const RayCaster>& caster);

  const std::size_t max_elements_;
  std::mutex mutex_;
  Casters casters_;  // Used last comes first; few. Guarded by mutex_.
  std::size_t elements_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_INDEX_CACHE_H_
