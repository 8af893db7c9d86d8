// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_SOLVER_H_
#define FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_SOLVER_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/execution/cancellation.h"
#include "core/execution/clock.h"
#include "core/execution/executor.h"
#include "core/plane/exact/exact.h"
#include "core/plane/exact/light_solver.h"
#include "core/plane/glossy/cell_mesh.h"
#include "core/plane/glossy/glossy_radiosity.h"
#include "core/plane/ray_caster.h"
#include "core/plane/reference/bounded_solver.h"
#include "core/plane/reference/chart.h"
#include "core/plane/reference/chosen_points.h"
#include "core/plane/reference/reference_solver.h"
#include "core/plane/reference/visibility_events.h"

namespace flatlight {

// Whether light that the scene reflects can be solved for by place and direction: all that reflects is Lambertian or a
// phong lobe, and some is the latter; there are no Béziers.
bool IsGlossy(const Scene& scene);

// Irradiance of all bounces, with a bound on its error, where curves reflect by phong lobes and Lambertian. Works in
// rounds, each with a finer mesh of places and directions (GlossyRadiosity).
class GlossySolver final : public BoundedSolver {
 public:
  // The caster's scene has the world of `scene`. Requires IsGlossy(scene), and neither derivatives nor max_bounces.
  GlossySolver(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
               const ReferenceOptions& options);
  ~GlossySolver() override;

  void Advance(Executor& executor, int threads, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  State state() const override { return state_; }
  const std::vector<ExactValue>& values() const override { return values_; }
  std::vector<ExactValue> FirstValues() const override;
  double relative_error() const override { return relative_error_; }
  double first_relative_error() const override { return first_relative_error_; }
  int rounds() const override { return rounds_; }
  std::unique_ptr<SolvedWorld> TakeWorld() override { return nullptr; }
  std::size_t cells() const { return radiosity_ ? radiosity_->mesh().cells().size() : 0; }

 private:
  struct Worker;
  enum class Step : std::uint8_t { kDirect, kEvents, kRows, kSolve, kCheck, kSpread, kBound, kPoints };

  std::unique_ptr<Worker> Take();
  void Return(std::unique_ptr<Worker> worker);
  std::size_t Count() const;
  void Work(Worker& worker, std::size_t i);
  bool StepWhole(Executor& executor, int threads);
  void Gather(Worker& worker, std::size_t point);
  void NextStep();
  void StartFirstMesh();
  void StartMesh(CellMesh mesh, std::vector<std::vector<double>> start);
  void EndPoints();
  // Appends places to split a panel at, and its parts again, so many times in all; in order.
  void SplitTimes(const Panel& panel, int times, std::vector<double>& places) const;
  struct Splits {
    std::vector<std::vector<double>> places;  // By panel.
    std::vector<CellMesh::Borders> borders;   // The same: of its directions, those it has too.
    double growth = 0;                        // Of the number of cells.
    bool any = false;
  };
  Splits SplitsAbove(const std::vector<double>& shares, double stays) const;
  void Refine();
  double SizeAt(const ExactValue& value, std::size_t point, int channel) const;
  bool IsWhole() const { return step_ == Step::kSolve || step_ == Step::kBound; }

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const RayCaster> caster_;
  const Scene& world_;
  ReferenceOptions options_;
  std::size_t channels_;
  ChosenPoints points_;
  std::vector<Chart> charts_;
  std::vector<std::vector<double>> meetings_;
  std::optional<EventFinder> finder_;  // Until the first mesh.
  std::vector<std::vector<EventPlace>> found_;
  Events kinks_;
  LightSolver lights_;
  std::vector<ExactValue> direct_;  // By point.
  std::vector<Spectrum> means_;     // By probe, of irradiance after the round before.
  double tolerance_;                // To which equations are solved.

  Step step_ = Step::kDirect;
  std::size_t next_ = 0;  // In the step.
  std::unique_ptr<GlossyRadiosity> radiosity_;
  std::vector<ExactValue> coming_;  // By point, of this round.

  State state_ = State::kWorks;
  std::vector<ExactValue> values_;
  double relative_error_ = 0, first_relative_error_ = 0;
  int rounds_ = 0, idle_rounds_ = 0;

  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;  // Guarded by mutex_.
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_PLANE_GLOSSY_GLOSSY_SOLVER_H_
