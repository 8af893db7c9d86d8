// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_PATH_TRACING_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_PATH_TRACING_RENDERING_H_

#include <memory>
#include <string>
#include <string_view>

#include "core/plane/ray_caster.h"
#include "core/render/progressive_sampling.h"
#include "core/render/rendering.h"

namespace flatlight {

// All bounces, by Monte Carlo.
class PathTracingRendering final : public Rendering {
 public:
  // The caster's scene has the world of `scene`; it may be null where nothing emits.
  PathTracingRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster, const Plan& plan);

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return sampling_.done(); }
  EndReason end_reason() const override { return sampling_.end_reason(); }
  RenderProgress Progress() const override { return sampling_.Progress(); }
  std::shared_ptr<const Field> Snapshot() const override;
  std::string Checkpoint(std::size_t most_bytes) const override { return sampling_.Checkpoint(most_bytes); }
  bool Resume(std::string_view checkpoint) override { return sampling_.Resume(checkpoint); }

 private:
  std::shared_ptr<const Scene> scene_;
  int max_threads_;
  ProgressiveSampling sampling_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PATH_TRACING_RENDERING_H_
