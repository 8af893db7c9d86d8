// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_EXACT_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_EXACT_RENDERING_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/plane/exact/exact.h"
#include "core/plane/exact/light_solver.h"
#include "core/plane/ray_caster.h"
#include "core/plane/triangulation/triangulation.h"
#include "core/render/idle_pool.h"
#include "core/render/ordered_work.h"
#include "core/render/rendering.h"

namespace flatlight {

// How much of exact light a plan wants.
ExactOptions ExactOptionsOf(const Plan& plan);

// Direct light in closed form, point after point. A probe appears in the field when all its points are done.
class ExactRendering final : public Rendering {
 public:
  // The caster's scene has the world of `scene`, and so has the triangulation's. The caster may be null where nothing
  // emits, the triangulation anywhere.
  ExactRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                 std::shared_ptr<const Triangulation> triangulation, const Plan& plan);

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return work_.done(); }
  EndReason end_reason() const override { return EndReason::kConverged; }
  RenderProgress Progress() const override;
  std::shared_ptr<const Field> Snapshot() const override;
  std::string Checkpoint(std::size_t most_bytes) const override;
  bool Resume(std::string_view checkpoint) override;

 private:
  // Evaluates [first, last); false if cancelled.
  bool Work(std::size_t first, std::size_t last, const Cancellation& cancellation);

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const RayCaster> caster_;
  std::shared_ptr<const Triangulation> triangulation_;
  ExactOptions options_;
  std::optional<LightSolver> lights_;  // If there are any.
  int derivatives_;                    // Asked for, whatever is computed.
  bool dark_;                          // Nothing emits: the values are there already.
  int max_threads_;
  IdlePool<ExactSolver> solvers_;
  std::vector<const Receiver*> points_;
  std::vector<ExactValue> values_;  // By point.
  OrderedWork work_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_EXACT_RENDERING_H_
