// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_REFERENCE_REFERENCE_SOLVER_H_
#define FLATLIGHT_CORE_PLANE_REFERENCE_REFERENCE_SOLVER_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/plane/exact/exact.h"
#include "core/plane/exact/light_solver.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/bounded_solver.h"
#include "core/plane/reference/chosen_points.h"
#include "core/plane/reference/radiosity.h"
#include "core/plane/reference/solved_world.h"
#include "core/plane/reference/specular_view.h"
#include "core/plane/reference/visibility_events.h"

namespace flatlight {

struct ReferenceOptions {
  int derivatives = 2;
  int channels = kMaxChannels;  // The first ones are computed, the others get the first one's values.
  std::optional<std::uint32_t> max_bounces;
  // Refines until the bound on every point's error is at most so many times max(irradiance, 1 % of its probe's mean).
  double target_error = 1e-6;
  // Of a probe, spread evenly: the bounds of so many points count, and these have values.
  std::size_t most_points = std::numeric_limits<std::size_t>::max();
};

// Light of all bounces at the points of a scene's probes: direct light in closed form, what curves reflect from panels
// that are split until the bound on the error is small enough. Works in rounds, each with a finer mesh.
class ReferenceSolver final : public BoundedSolver {
 public:
  // The caster's scene has the world of `scene`. Requires CanFollow(scene), and no max_bounces where something is a
  // mirror or glass and light is reflected, nor derivatives if there are Béziers as well. `before`: to go on from, of
  // the same world, channels and bounces; its caster is used. Its panels are the first round's; null: there is none.
  ReferenceSolver(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                  const ReferenceOptions& options, std::unique_ptr<SolvedWorld> before = nullptr);
  ~ReferenceSolver() override;

  void Advance(Executor& executor, int threads, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  State state() const override { return state_; }
  const std::vector<ExactValue>& values() const override { return values_; }
  std::vector<ExactValue> FirstValues() const override;
  double relative_error() const override { return relative_error_; }
  double first_relative_error() const override { return first_relative_error_; }
  int rounds() const override { return rounds_; }
  std::size_t panels() const { return world_->radiosity->mesh().size(); }
  // The panels, and what they reflect, after the last round. Only when the work is done.
  const PanelMesh& mesh() const { return world_->radiosity->mesh(); }
  const PanelLight& light() const { return world_->radiosity->light(); }
  std::unique_ptr<SolvedWorld> TakeWorld() override;

 private:
  struct Worker;
  // A point that is no better after so many rounds has no say any more.
  static constexpr int kMostIdleRounds = 3;
  // To which equations are solved in the end: of the target error; and at least.
  static constexpr double kTolerance = 1e-3;
  static constexpr double kLeastTolerance = 1e-15;
  // How far ways over mirrors and glass are followed from a point, and what that leaves of its bound.
  struct ViewLimit {
    double least_share = 0;
    Spectrum unfollowed = {};  // Of ways from the point itself,
    Spectrum indirect = {};    // and what the error of what panels reflect adds, of whatever that comes.
    double before = std::numeric_limits<double>::infinity();  // Unfollowed, when ways were last followed further.
    std::optional<SpecularSight> sight = {};                  // Kept from round to round, if there is memory for it.
  };
  enum class Step : std::uint8_t {
    kDirect,
    kEvents,
    kRows,
    kSolve,
    kCheck,
    kSpread,
    kCorrect,
    kBound,
    kSlopes,
    kPoints,
    kSplit
  };

  std::unique_ptr<Worker> Take();
  void Return(std::unique_ptr<Worker> worker);
  // Of the step: pieces of work, and one of them.
  std::size_t Count() const;
  void Work(Worker& worker, std::size_t i);
  // One step of what all panels take part in. Returns whether it is done.
  bool StepWhole(Executor& executor, int threads);
  void FindSlopes(Worker& worker, std::size_t panel);
  void Gather(Worker& worker, std::size_t point);
  void NextStep();
  // Of all workers: shares_, and how much a bound on each panel's light adds to points.
  void CollectShares(std::vector<double>& importance);
  void EndPoints();
  double SizeAt(std::size_t point, int channel) const;
  void FollowFurther();
  void StartMesh(PanelMesh mesh);
  void StartFirstMesh();
  void StartRound();
  // Of a round, once the light of panels is known.
  Step FirstOfPoints() const { return options_.derivatives < 2 ? Step::kPoints : Step::kSlopes; }
  bool IsWhole() const { return step_ == Step::kSolve || step_ == Step::kCorrect || step_ == Step::kBound; }

  std::shared_ptr<const Scene> scene_;
  ReferenceOptions options_;
  std::size_t channels_;
  ChosenPoints points_;
  std::unique_ptr<SolvedWorld> world_;
  std::optional<EventFinder> finder_;  // Until the first mesh.
  std::vector<std::vector<EventPlace>> found_;
  double tolerance_;         // To which equations are solved in the end, and
  double coarse_tolerance_;  // in this round.
  LightSolver lights_;
  std::optional<SpecularViewOptions> specular_;  // Of rows.
  std::vector<ExactValue> direct_;               // By point.
  std::vector<char> has_direct_;
  std::vector<Spectrum> means_;  // By probe, of irradiance after the round before.

  Step step_ = Step::kDirect, after_direct_ = Step::kEvents;
  std::size_t next_ = 0;            // In the step.
  std::vector<ExactValue> coming_;  // By point, of this round.
  std::vector<double> shares_;      // By panel: the largest share of the error that is allowed.
  std::vector<ViewLimit> limits_;   // By point.
  std::atomic<std::size_t> sight_bytes_ = 0;
  std::vector<char> goes_further_;  // By point: its bound is less in the next round for ways followed further.
  bool new_rows_ = false;           // All rows are made anew then.
  std::vector<char> split_;
  std::vector<std::vector<double>> places_;

  State state_ = State::kWorks;
  std::vector<ExactValue> values_;
  double relative_error_ = 0, first_relative_error_ = 0;
  int rounds_ = 0;
  // By point: the error after the round before in units of what it is relative to, and how many rounds brought little.
  std::vector<double> relative_before_;
  std::vector<int> idle_rounds_;
  // By point, of channels: it is all but dark. Such points have a say in what to split when all others are done.
  std::vector<char> dark_;
  bool dark_waits_ = false;
  double to_improve_ = 0;  // The largest of points that still improved.

  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;  // Guarded by mutex_.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_REFERENCE_REFERENCE_SOLVER_H_
