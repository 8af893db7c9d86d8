// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_RAY_TRACING_RENDERING_H_
#define FLATLIGHT_CORE_RENDER_RAY_TRACING_RENDERING_H_

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/plane/exact/light_solver.h"
#include "core/plane/ray_caster.h"
#include "core/plane/ray_tracing/formulations.h"
#include "core/plane/ray_tracing/hemicircle_gather.h"
#include "core/render/rendering.h"
#include "core/statistics/replicates.h"

namespace flatlight {

// Branching Monte Carlo with derivatives. A point's estimate comes from one gather a replicate; passes over all points
// use ever more rays, and each starts afresh, for strata of different size do not mix. With a target error, a pass that
// meets it decides, and the next, which nobody looked at, is delivered: unbiased.
class RayTracingRendering final : public Rendering {
 public:
  // The caster's scene has the world of `scene`; it may be null where nothing emits.
  RayTracingRendering(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster, const Plan& plan);

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget) override;
  bool done() const override { return end_reason_.has_value(); }
  EndReason end_reason() const override { return *end_reason_; }
  RenderProgress Progress() const override;
  std::shared_ptr<const Field> Snapshot() const override;
  std::string Checkpoint(std::size_t most_bytes) const override;
  bool Resume(std::string_view checkpoint) override;

 private:
  static constexpr int kOrders = 3;  // Irradiance, gradient, Hessian.
  static constexpr int kRotation = kOrders;
  static constexpr int kQuantities = kOrders + 1;
  // Rotation comes with the gradient.
  bool Computes(int quantity) const { return quantity == kRotation ? orders_ > 1 : quantity < orders_; }
  struct Estimate {
    std::array<Spectrum, kQuantities> value;
    std::array<std::array<HalvesSpread, kMaxChannels>, kQuantities> spread;  // Of replicates.
    std::array<double, kQuantities> step = {};                               // The most that a replicate may miss.
    std::array<double, kQuantities> rounding = {};
    std::array<double, kMaxChannels> range = {};  // Of the replicates' irradiance.
    std::optional<Spectrum> error;                // Of irradiance, once the pass was over.
    std::uint32_t rays = 0;                       // Of a replicate's gather; 0: there is none yet.

    template <class Self, class Stream>
    static void State(Self& self, Stream& stream) {
      stream(self.value, self.spread, self.step, self.rounding, self.range, self.error, self.rays);
    }
  };
  // What one gather gives.
  struct Gathered {
    std::array<Spectrum, kQuantities> value;
    double steepest = 0;  // Inverse distance of the nearest hit.
    double cast = 0;
    bool whole = false;

    template <class Self, class Stream>
    static void State(Self& self, Stream& stream) {
      stream(self.value, self.steepest, self.cast, self.whole);
    }
  };
  enum class Decision : std::uint8_t { kOpen, kLast, kFinal };

  // What a checkpoint consists of, beside the time since the start.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream);
  void BeginPass(std::uint32_t rays);
  void PlanPass(Clock::Time now);
  Gathered Gather(std::size_t point, std::size_t replicate, const Cancellation& cancellation) const;
  // Light of lights without a surface over mirrors and glass.
  void AddChained(const Receiver& receiver, const std::vector<ChainedLight>& ways,
                  std::array<Spectrum, kQuantities>& value) const;
  void FinishPoint(std::size_t point, const Gathered* gathered);
  // Standard errors of irradiance at all points: where replicates agree neighbours of the same pass tell what they
  // miss.
  std::vector<Spectrum> IrradianceErrors() const;
  // The same of any quantity. Derivatives by strata are not quite unbiased, and halves of the replicates do not tell a
  // bias that both have: there the doubt stays as large as it may be.
  std::vector<Spectrum> Errors(std::size_t quantity) const;
  double RelativeErrorAt(std::size_t point, const Spectrum& error, const std::vector<Spectrum>& means) const;
  std::vector<Spectrum> MeansOverProbes() const;

  std::shared_ptr<const Scene> scene_;
  std::optional<RayTree> tree_;  // Absent in the dark.
  std::optional<LightSolver> lights_;
  Settings settings_;
  int orders_;  // Computed.
  int max_threads_;
  double brightest_ = 0;  // Largest radiance of what rays may meet.
  std::vector<Receiver> points_;
  std::vector<double> missed_;  // By point: MissedAtHorizon.
  std::vector<std::size_t> probe_of_point_;
  std::vector<Estimate> estimates_;
  std::vector<Decision> decisions_;
  std::uint32_t pass_rays_ = 0;
  std::uint32_t last_rays_ = 0;       // The last pass's, if samples are given.
  std::vector<std::size_t> pass_;     // Points of the pass.
  std::size_t next_task_ = 0;         // (point of the pass, replicate), in this order.
  std::vector<Gathered> unfinished_;  // Of the point in the middle of which the last call ended.
  double tasks_per_second_ = 0;
  double rays_ = 0;
  double work_done_ = 0;  // In rays of the first level.
  std::optional<double> worst_error_;
  std::optional<Clock::Time> start_;
  std::optional<Clock::Duration::rep> resumed_;  // Time since the start, until the first Advance after it.
  Clock::Time now_;                              // At the end of the last Advance.
  double seconds_ = 0;
  std::optional<EndReason> end_reason_;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_RAY_TRACING_RENDERING_H_
