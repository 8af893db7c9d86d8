// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_REFERENCE_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_REFERENCE_RENDERING_H_

#include <memory>
#include <optional>

#include "core/plane/ray_caster.h"
#include "core/plane/reference/bounded_solver.h"
#include "core/render/rendering.h"
#include "core/render/solved_worlds.h"

namespace flatlight {

// Light of all bounces with bounds on its error, round after round. The field has the values of the last round. Goes on
// from what is known of the world, and keeps what it finds, so that values may differ within their bounds by what was
// rendered before; the same job twice has the same bits.
class ReferenceRendering final : public Rendering {
 public:
  // The caster's scene has the world of `scene`; it may be null where nothing emits.
  ReferenceRendering(std::shared_ptr<const Scene> scene, const std::shared_ptr<const RayCaster>& caster,
                     const Plan& plan, std::shared_ptr<SolvedWorlds> worlds, std::string sharers);

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return end_reason_.has_value(); }
  EndReason end_reason() const override { return *end_reason_; }
  RenderProgress Progress() const override;
  std::shared_ptr<const Field> Snapshot() const override;

 private:
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<SolvedWorlds> worlds_;
  std::string sharers_;  // Whose those of `worlds_` may be.
  int derivatives_;
  double target_error_;
  std::optional<double> time_limit_;  // s
  int max_threads_;
  std::unique_ptr<BoundedSolver> solver_;  // Null where all is dark.
  std::optional<Clock::Time> start_;
  std::optional<EndReason> end_reason_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_REFERENCE_RENDERING_H_
