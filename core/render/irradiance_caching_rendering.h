// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_IRRADIANCE_CACHING_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_IRRADIANCE_CACHING_RENDERING_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/cache/placement.h"
#include "core/cache/record.h"
#include "core/plane/irradiance_caching/record_maker.h"
#include "core/plane/irradiance_caching/track.h"
#include "core/plane/irradiance_caching/track_events.h"
#include "core/plane/ray_caster.h"
#include "core/plane/ray_tracing/ray_tree.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/reference_solver.h"
#include "core/render/idle_pool.h"
#include "core/render/photon_source.h"
#include "core/render/rendering.h"

namespace flatlight {

// First the light that curves reflect, if panels or photons tell it, and the visibility events along the points, if
// error control asks for them. Then records are made in waves; a wave is a function of the records before it alone.
// Points are interpolated from the records of whole waves.
class IrradianceCachingRendering final : public Rendering {
 public:
  // The caster's scene has the world of `scene`; it may be null where nothing emits.
  IrradianceCachingRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                             const Plan& plan);

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return done_; }
  EndReason end_reason() const override;
  RenderProgress Progress() const override;
  std::shared_ptr<const Field> Snapshot() const override;
  // Of events and records; panels and photons are found again. None before these are.
  std::string Checkpoint(std::size_t most_bytes) const override;
  bool Resume(std::string_view checkpoint) override;

 private:
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream);
  // Whether records of this gather may be off by so much.
  bool IsGoodEnough(const CacheRecord& record) const;
  void Prepare();
  // With what is of use of an earlier job's records; events are known.
  void BeginWaves();
  void FindEvents(Executor& executor, int threads, const Cancellation& cancellation);
  void MakeRecords(Executor& executor, int threads, const Cancellation& cancellation);
  std::unique_ptr<RecordMaker> TakeMaker();

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const RayCaster> caster_;
  int max_threads_;
  PlacementOptions placement_options_;
  RecordMakerOptions maker_options_;
  std::optional<RayTree> tree_;            // If rays are gathered,
  std::optional<RayTree> doubt_;           // and if they end in a photon map: what they are off by.
  std::optional<ReferenceSolver> panels_;  // If panels tell what is reflected.
  std::optional<PhotonSource> photons_;    // If rays end in a photon map.
  std::vector<Chart> charts_;
  Tracks tracks_;
  std::shared_ptr<const std::vector<RecordField>> known_records_;  // Of an earlier job; null if there are none.
  std::size_t reused_ = 0;                                         // Of these: the first of `records_`.
  std::optional<Placement> placement_;                             // Unless all is dark.
  // Stretches of tracks that are yet to be searched for events begin at (track, index of a point).
  std::vector<std::pair<std::uint32_t, std::size_t>> stretches_;
  std::size_t searched_ = 0;
  std::vector<std::vector<VisibilityEvent>> events_;  // By track, in order.
  std::vector<CacheRecord> records_;                  // Of whole waves.
  std::vector<RecordPlace> wave_;                     // The wave that is being made,
  std::vector<CacheRecord> made_;                     // and its records so far.
  std::uint32_t waves_ = 0;
  double rays_ = 0;
  std::string resumed_;        // The checkpoint that this began with, until it has come further.
  bool has_advanced_ = false;  // Since then.
  bool begun_ = false;         // There was a first wave.
  bool done_ = false;
  IdlePool<RecordMaker> makers_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_IRRADIANCE_CACHING_RENDERING_H_
