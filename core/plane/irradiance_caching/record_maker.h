// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_RECORD_MAKER_H_
#define FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_RECORD_MAKER_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "core/cache/error_control.h"
#include "core/cache/record.h"
#include "core/execution/cancellation.h"
#include "core/plane/irradiance_caching/reflected_series.h"
#include "core/plane/irradiance_caching/skyline.h"
#include "core/plane/irradiance_caching/track.h"
#include "core/plane/ray_tracing/ray_tree.h"
#include "core/plane/reference/chart.h"
#include "core/scene/scene.h"

namespace flatlight {

struct RecordMakerOptions {
  ErrorControl control = ErrorControl::kVisibilityEvents;
  // What is reflected comes from these panels if there are any, else from rays gathered at each record; with neither
  // there is direct light alone.
  std::optional<ReflectedLight> reflected;
  double reflected_error = 0;  // Of irradiance from them, relative.
  std::uint32_t rays = 0;
  // Where those rays end in what was found before: a tree that tells what this may be off by. Null otherwise.
  const RayTree* doubt = nullptr;
  std::uint64_t key = 0;  // Of all that is random.
};

// Makes records: direct light and its derivatives in closed form; what is reflected from panels, as exactly as they are
// known, or from a gather of rays, its derivatives from the jumps of radiance between them, which move by the break
// law. Holds working memory: one for each thread.
class RecordMaker {
 public:
  // All must outlive this. `tree` may be null if no rays are gathered.
  RecordMaker(const RecordMaker&) = delete;
  RecordMaker& operator=(const RecordMaker&) = delete;
  RecordMaker(const RayCaster& caster, const std::vector<Chart>& charts, const RayTree* tree,
              const RecordMakerOptions& options);

  // On the track of a number. Of no use if cancelled. Adds the rays cast.
  CacheRecord Make(const Track& track, std::uint32_t index, double at, std::uint32_t wave,
                   const Cancellation& cancellation, double& cast);

  Skyline& skyline() { return skyline_; }

 private:
  void AddReflected(const Receiver& receiver, std::uint64_t key, const Cancellation& cancellation, CacheRecord& record,
                    double& cast) const;

  const RayCaster& caster_;
  const RayTree* tree_;
  RecordMakerOptions options_;
  std::optional<ReflectedSeries> reflected_;
  Skyline skyline_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_IRRADIANCE_CACHING_RECORD_MAKER_H_
