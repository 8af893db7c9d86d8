// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_RENDER_PROGRESSIVE_SAMPLING_H_
#define FLATLIGHT_CORE_RENDER_PROGRESSIVE_SAMPLING_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/render/point_blocks.h"
#include "core/render/point_estimates.h"
#include "core/render/point_sampler.h"
#include "core/render/rendering.h"
#include "core/statistics/crossed_halves.h"

namespace flatlight {

struct SamplingGoal {
  std::optional<std::uint32_t> samples;  // A point; rounded up to whole blocks.
  std::optional<double> target_error;
  std::optional<double> time_limit;  // s since the first Advance.
  bool skip_converged = true;        // Points that have met the target error get no further samples.
};

// Samples points in rounds: one block each at first, for an early picture, then twice as many every round. Points have
// equal counts at the end of a round, unless some met the target error.
//
// With a target error each point stops by crossed halves, tested at 64 samples a point, 128, 256, ...: unbiased, but
// the error known in the end is not the one that decided. Points whose final error misses the target go on, a few in a
// hundred. That this looks at the sample itself is a bias in principle; for rare bright, two-valued and exponential
// samples it was measured as 0.00 to 0.05 (+- 0.02) of the stated error.
//
// A point that has not met its rare bright samples yet looks as if it had no error. So no point stops while one more
// sample, as bright as any that its neighbours have met or as the scene allows where they have met few, would matter
// beside the target; and where its replicates all agree, such a sample counts as missed (EstimateMean).
class ProgressiveSampling {
 public:
  // probe_ends[i] is one past the last point of probe i.
  ProgressiveSampling(std::unique_ptr<const PointSampler> sampler, std::vector<std::size_t> probe_ends,
                      const SamplingGoal& goal);

  void Advance(Executor& executor, int max_threads, const Cancellation& cancellation, const Clock& clock,
               Clock::Duration budget);
  bool done() const { return end_reason_.has_value(); }
  EndReason end_reason() const { return *end_reason_; }
  RenderProgress Progress() const;

  // One estimate a channel, and the samples behind them: 0 if there is none yet.
  struct PointValue {
    std::vector<MeanEstimate> estimates;
    double samples = 0;
  };
  std::vector<PointValue> Values() const;  // By point.
  std::size_t channels() const { return blocks_.channels(); }
  double rays() const { return blocks_.rays(); }

  // As Rendering's.
  std::string Checkpoint(std::size_t most_bytes) const;
  bool Resume(std::string_view checkpoint);

 private:
  // What a checkpoint consists of, beside the times since the sampling and its round began.
  template <class Self, class Stream>
  static void State(Self& self, Stream& stream);
  struct Elapsed {
    Clock::Duration::rep since_start = 0;
    Clock::Duration::rep since_round_start = 0;
  };

  // Means of values over each probe, channel after channel.
  using ProbeMeans = std::vector<double>;

  // When the time limit is over; Time::max() if there is none.
  Clock::Time TimeLimit() const;
  void EndInRound();
  void EndRound(Clock::Time now);
  void OfferHalves();
  // Reopens decided points whose own error misses the target. True if all points are decided and none was reopened.
  bool ConfirmDecisions();
  // Sets the goals of the next round, or the reason why there is none.
  void PlanRound(Clock::Time now);
  void UpdateWorstError();
  // estimates(point) gives one a channel.
  template <typename Estimates>
  ProbeMeans MeansOverProbes(const Estimates& estimates) const;
  double WorstError(std::size_t point, const PointValue& value, const ProbeMeans& means) const;
  // Of the points of a probe.
  PointEstimates EstimatesOf(std::size_t probe) const;
  // One estimate a channel of each half.
  std::array<CrossedHalves::HalfEstimate, 2> HalvesOf(std::size_t point, const PointEstimates& estimates) const;
  bool Active(std::size_t point) const { return !goal_.target_error.has_value() || !halves_[point].decided(); }

  std::unique_ptr<const PointSampler> sampler_;
  std::vector<std::size_t> probe_ends_;
  std::vector<std::size_t> probe_of_point_;
  SamplingGoal goal_;
  std::uint64_t most_blocks_;
  PointBlocks blocks_;
  // Takes the samples of decided points if they are not skipped. Nothing reads them: they show that skipping is right.
  std::optional<PointBlocks> unread_;
  std::vector<CrossedHalves> halves_;      // By point; empty without a target error.
  std::array<ProbeMeans, 2> pilot_means_;  // Of each half at the first test; they set the targets' floors.
  bool round_is_whole_ = true;             // It brings every active point to a count at which decisions are due.
  std::optional<EndReason> end_reason_;
  std::optional<double> worst_error_;
  std::optional<Clock::Time> start_;
  std::optional<Elapsed> resumed_;  // Until the first Advance after it.
  Clock::Time now_;
  Clock::Time round_start_;
  double round_start_blocks_ = 0;
};

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PROGRESSIVE_SAMPLING_H_
