// SPDX-License-Identifier: Apache-2.0
// The one door to transport: a scene and a plan become a field, in slices that the caller paces.
#ifndef FLATLIGHT_CORE_RENDER_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_RENDERING_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/render/field.h"
#include "core/render/index_cache.h"
#include "core/render/plan.h"
#include "core/scene/scene.h"

namespace flatlight {

enum class EndReason : std::uint8_t {
  kConverged,
  kSamplesDone,
  kTargetReached,
  kTimeLimit,
  kAccuracyLimit  // The target error was not reached; rounding or memory let the error become no smaller.
};

// How far a rendering has come is a function of the blocks done, never of who did them: for equal blocks done the field
// has equal bits, whatever the threads, the slices and the budgets were.
class Rendering {
 public:
  virtual ~Rendering() = default;

  // Works for about `budget` (checked between shards of a few milliseconds), until done or cancelled. A cancelled call
  // leaves the blocks it had finished. Not to be called from two threads at once, nor together with the calls below.
  virtual void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                       Clock::Duration budget) = 0;
  virtual bool done() const = 0;
  virtual EndReason end_reason() const = 0;  // Requires done().
  virtual RenderProgress Progress() const = 0;
  virtual std::shared_ptr<const Field> Snapshot() const = 0;

  // The work done so far as bytes, a function of that work alone (and, with a time limit, of the time it took). Empty
  // where it cannot be kept, or takes more than `most_bytes`: the rendering then begins anew, and ends with the same
  // bits. Not to be called between a cancelled Advance and the next one.
  virtual std::string Checkpoint(std::size_t /*most_bytes*/) const { return {}; }
  // Goes on from a checkpoint of a rendering of the same scene and plan, by the same build. To be called before
  // Advance. False if it is none: this rendering is then of no use, start another.
  virtual bool Resume(std::string_view /*checkpoint*/) { return false; }
};

// `plan` must come from MakePlan for this scene. Takes its index from `indexes`, what they have for `sharers`, or makes
// its own.
std::unique_ptr<Rendering> StartRendering(std::shared_ptr<const Scene> scene, const Plan& plan, IndexCache& indexes,
                                          const std::string& sharers = "");
std::unique_ptr<Rendering> StartRendering(std::shared_ptr<const Scene> scene, const Plan& plan);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_RENDERING_H_
