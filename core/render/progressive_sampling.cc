// SPDX-License-Identifier: Apache-2.0
#include "core/render/progressive_sampling.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/render/state_stream.h"

namespace flatlight {
namespace {

using Seconds = std::chrono::duration<double>;

// Decisions are never due before 64 samples of a point: smaller samples know too little of their own error.
constexpr std::uint64_t kFirstTestBlocks = 64 / PointSampler::kBlockSamples;
// The dimmest that the target error is relative to, in means of the probe (DESIGN 3).
constexpr double kDarkest = 0.01;

Clock::Time Later(Clock::Time time, Clock::Duration duration) {
  // A time before the clock's zero, of a resumed rendering, has more room than a duration can hold.
  if (time.time_since_epoch() <= Clock::Duration::zero()) return time + duration;
  return duration > Clock::Time::max() - time ? Clock::Time::max() : time + duration;
}

}  // namespace

ProgressiveSampling::ProgressiveSampling(std::unique_ptr<const PointSampler> sampler,
                                         std::vector<std::size_t> probe_ends, const SamplingGoal& goal)
    : sampler_(std::move(sampler)),
      probe_ends_(std::move(probe_ends)),
      goal_(goal),
      most_blocks_(PointBlocks::kMostBlocks),
      blocks_(*sampler_, probe_ends_.empty() ? 0 : probe_ends_.back()) {
  if (goal_.samples.has_value()) {
    most_blocks_ = (*goal_.samples + PointSampler::kBlockSamples - 1) / PointSampler::kBlockSamples;
  }
  for (std::size_t probe = 0; probe < probe_ends_.size(); ++probe) probe_of_point_.resize(probe_ends_[probe], probe);
  if (goal_.target_error.has_value()) {
    halves_.resize(blocks_.points());
    if (!goal_.skip_converged) unread_.emplace(*sampler_, blocks_.points());
  }
}

void ProgressiveSampling::Advance(Executor& executor, int max_threads, const Cancellation& cancellation,
                                  const Clock& clock, Clock::Duration budget) {
  now_ = clock.Now();
  const Clock::Time until = Later(now_, budget);
  if (resumed_.has_value()) {
    start_ = now_ - Clock::Duration(resumed_->since_start);
    round_start_ = now_ - Clock::Duration(resumed_->since_round_start);
    resumed_.reset();
  } else if (!start_.has_value()) {
    start_ = now_;
    PlanRound(now_);
  }
  while (!done() && !cancellation.cancelled()) {
    const Clock::Time stop = std::min(until, TimeLimit());
    const bool round_done = blocks_.Advance(executor, max_threads, cancellation, clock, stop) &&
                            (!unread_ || unread_->Advance(executor, max_threads, cancellation, clock, stop));
    now_ = clock.Now();
    if (!round_done) {
      if (now_ >= TimeLimit()) EndInRound();
      return;
    }
    EndRound(now_);
    if (now_ >= until) return;
  }
}

Clock::Time ProgressiveSampling::TimeLimit() const {
  constexpr double kForever = 1e9;  // s
  if (!goal_.time_limit.has_value() || *goal_.time_limit > kForever) return Clock::Time::max();
  return Later(*start_, std::chrono::duration_cast<Clock::Duration>(Seconds(*goal_.time_limit)));
}

// Rounds are planned to end before the time does, but for the first one, and where blocks take longer and longer.
void ProgressiveSampling::EndInRound() {
  end_reason_ = EndReason::kTimeLimit;
  for (std::size_t point = 0; point < blocks_.points(); ++point)
    if (blocks_.blocks(point) == 0) return;
  UpdateWorstError();
}

void ProgressiveSampling::EndRound(Clock::Time now) {
  if (goal_.target_error.has_value() && round_is_whole_) OfferHalves();
  UpdateWorstError();
  PlanRound(now);
}

void ProgressiveSampling::OfferHalves() {
  std::vector<std::array<CrossedHalves::HalfEstimate, 2>> halves(blocks_.points());
  std::vector<PointEstimates> estimates;
  for (std::size_t probe = 0; probe < probe_ends_.size(); ++probe) estimates.push_back(EstimatesOf(probe));
  for (std::size_t point = 0; point < halves.size(); ++point)
    if (!halves_[point].decided()) halves[point] = HalvesOf(point, estimates[probe_of_point_[point]]);
  if (pilot_means_[0].empty() && !halves.empty() && blocks_.blocks(0) >= kFirstTestBlocks) {
    for (const std::size_t half : {0, 1}) {
      pilot_means_[half] = MeansOverProbes([&](std::size_t point) -> const auto& { return halves[point][half]; });
    }
  }
  for (std::size_t point = 0; point < halves.size(); ++point) {
    if (halves_[point].decided() || blocks_.blocks(point) < kFirstTestBlocks) continue;
    std::array<CrossedHalves::Target, 2> targets;
    for (std::size_t half = 0; half < 2; ++half) {
      targets[half].relative = *goal_.target_error;
      for (std::size_t c = 0; c < channels(); ++c) {
        targets[half].floor.push_back(kDarkest * pilot_means_[half][probe_of_point_[point] * channels() + c]);
        const Missable missable = estimates[probe_of_point_[point]].MissableBy({half, half + 1}, point, c);
        targets[half].brightest.push_back(std::max(missable.seen, missable.share * missable.largest));
      }
    }
    const double samples = static_cast<double>(blocks_.blocks(point)) * PointSampler::kBlockSamples;
    halves_[point].Offer(halves[point], samples, targets);
  }
}

bool ProgressiveSampling::ConfirmDecisions() {
  const std::vector<PointValue> values = Values();
  const ProbeMeans means = MeansOverProbes([&](std::size_t point) -> const auto& { return values[point].estimates; });
  bool confirmed = true;
  for (std::size_t point = 0; point < blocks_.points(); ++point) {
    if (halves_[point].decided() && WorstError(point, values[point], means) > *goal_.target_error)
      halves_[point].Reopen();
    confirmed = confirmed && halves_[point].decided();
  }
  return confirmed;
}

void ProgressiveSampling::PlanRound(Clock::Time now) {
  const std::size_t points = blocks_.points();
  if (goal_.target_error.has_value() && blocks_.total_blocks() > 0 && ConfirmDecisions()) {
    end_reason_ = EndReason::kTargetReached;
    return;
  }
  std::vector<std::uint64_t> goals(points);
  double added = 0;   // By the round.
  double active = 0;  // Points that go on.
  for (std::size_t point = 0; point < points; ++point) {
    const std::uint64_t blocks = blocks_.blocks(point);
    const bool goes_on = blocks < most_blocks_ && Active(point);
    goals[point] = goes_on ? std::min(std::max(2 * blocks, std::uint64_t{1}), most_blocks_) : blocks;
    added += static_cast<double>(goals[point] - blocks);
    active += goes_on ? 1 : 0;
  }
  if (active == 0) {
    end_reason_ = EndReason::kSamplesDone;
    return;
  }
  round_is_whole_ = true;
  if (goal_.time_limit.has_value() && blocks_.total_blocks() > 0) {
    // A round may take half of the time left; the last ones add one block a point, while the time allows.
    const double left = *goal_.time_limit - Seconds(now - *start_).count();
    const double seconds_per_block =
        Seconds(now - round_start_).count() / (blocks_.total_blocks() - round_start_blocks_);
    const double affordable = left > 0 ? left / std::max(seconds_per_block, 1e-12) : 0;
    if (affordable < active) {
      end_reason_ = EndReason::kTimeLimit;
      return;
    }
    if (added > affordable / 2) {
      round_is_whole_ = false;
      const double share = affordable / 2 / added;
      for (std::size_t point = 0; point < points; ++point) {
        const std::uint64_t blocks = blocks_.blocks(point);
        const double more = std::floor(share * static_cast<double>(goals[point] - blocks));
        if (goals[point] > blocks) goals[point] = blocks + std::max(static_cast<std::uint64_t>(more), std::uint64_t{1});
      }
    }
  }
  if (unread_.has_value()) {
    const std::uint64_t most = *std::max_element(goals.begin(), goals.end());
    std::vector<std::uint64_t> unread_goals(points);
    for (std::size_t point = 0; point < points; ++point) unread_goals[point] = Active(point) ? 0 : most;
    unread_->SetGoals(std::move(unread_goals));
  }
  round_start_ = now;
  round_start_blocks_ = blocks_.total_blocks();
  blocks_.SetGoals(std::move(goals));
}

void ProgressiveSampling::UpdateWorstError() {
  const std::vector<PointValue> values = Values();
  const ProbeMeans means = MeansOverProbes([&](std::size_t point) -> const auto& { return values[point].estimates; });
  double worst = 0;
  for (std::size_t point = 0; point < values.size(); ++point) {
    worst = std::max(worst, WorstError(point, values[point], means));
  }
  worst_error_.reset();
  if (std::isfinite(worst)) worst_error_ = worst;
}

double ProgressiveSampling::WorstError(std::size_t point, const PointValue& value, const ProbeMeans& means) const {
  double worst = 0;
  for (std::size_t c = 0; c < channels(); ++c) {
    const double floor = kDarkest * means[probe_of_point_[point] * channels() + c];
    const MeanEstimate& estimate = value.estimates[c];
    if (floor == 0 && estimate.mean == 0 && value.samples >= CrossedHalves::kSamplesBeforeDarkness) continue;
    worst = std::max(worst, RelativeError(estimate.mean, estimate.StandardError(), floor));
  }
  return worst;
}

template <typename Estimates>
ProgressiveSampling::ProbeMeans ProgressiveSampling::MeansOverProbes(const Estimates& estimates) const {
  ProbeMeans means(probe_ends_.size() * channels());
  std::size_t first = 0;
  for (std::size_t probe = 0; probe < probe_ends_.size(); ++probe) {
    for (std::size_t point = first; point < probe_ends_[probe]; ++point) {
      const std::vector<MeanEstimate>& of_point = estimates(point);
      for (std::size_t c = 0; c < channels(); ++c) means[probe * channels() + c] += of_point[c].mean;
    }
    const auto count = static_cast<double>(probe_ends_[probe] - first);
    for (std::size_t c = 0; c < channels(); ++c) means[probe * channels() + c] /= count;
    first = probe_ends_[probe];
  }
  return means;
}

PointEstimates ProgressiveSampling::EstimatesOf(std::size_t probe) const {
  return {blocks_, probe == 0 ? 0 : probe_ends_[probe - 1], probe_ends_[probe], !halves_.empty()};
}

std::array<CrossedHalves::HalfEstimate, 2> ProgressiveSampling::HalvesOf(std::size_t point,
                                                                         const PointEstimates& estimates) const {
  std::array<CrossedHalves::HalfEstimate, 2> halves;
  for (std::size_t half = 0; half < 2; ++half)
    for (std::size_t c = 0; c < channels(); ++c) halves[half].push_back(estimates.OfHalf(point, half, c));
  return halves;
}

std::vector<ProgressiveSampling::PointValue> ProgressiveSampling::Values() const {
  std::vector<PointValue> values(blocks_.points());
  std::size_t point = 0;
  for (std::size_t probe = 0; probe < probe_ends_.size(); ++probe) {
    const PointEstimates estimates = EstimatesOf(probe);
    for (; point < probe_ends_[probe]; ++point) {
      PointValue& value = values[point];
      value.samples = static_cast<double>(blocks_.blocks(point)) * PointSampler::kBlockSamples;
      if (value.samples == 0) continue;
      if (halves_.empty()) {
        for (std::size_t c = 0; c < channels(); ++c) value.estimates.push_back(estimates.Of(point, c));
        continue;
      }
      const auto halves = HalvesOf(point, estimates);
      for (std::size_t c = 0; c < channels(); ++c) value.estimates.push_back(halves_[point].Estimate(halves, c));
      value.samples = halves_[point].Samples(value.samples);
    }
  }
  return values;
}

template <class Self, class Stream>
void ProgressiveSampling::State(Self& self, Stream& stream) {
  stream(self.blocks_);
  bool has_unread = self.unread_.has_value();
  stream(has_unread);
  stream.Require(has_unread == self.unread_.has_value());
  if (has_unread && stream.ok()) stream(*self.unread_);
  std::uint64_t points_with_halves = self.halves_.size();
  stream(points_with_halves);
  stream.Require(points_with_halves == self.halves_.size());
  for (auto& halves : self.halves_) {
    if (stream.ok()) CrossedHalves::State(halves, stream, self.channels());
  }
  stream(self.pilot_means_, self.round_is_whole_, self.end_reason_, self.worst_error_, self.round_start_blocks_);
  for (const ProbeMeans& means : self.pilot_means_) {
    stream.Require(means.empty() || means.size() == self.probe_ends_.size() * self.channels());
  }
}

std::string ProgressiveSampling::Checkpoint(std::size_t most_bytes) const {
  if (!start_.has_value() && !resumed_.has_value()) return {};
  const Elapsed elapsed =
      resumed_.value_or(start_ ? Elapsed{(now_ - *start_).count(), (now_ - round_start_).count()} : Elapsed{});
  StateWriter writer(most_bytes);
  writer(elapsed.since_start, elapsed.since_round_start);
  State(*this, writer);
  return writer.Take();
}

bool ProgressiveSampling::Resume(std::string_view checkpoint) {
  StateReader reader(checkpoint);
  Elapsed& elapsed = resumed_.emplace(Elapsed{});
  reader(elapsed.since_start, elapsed.since_round_start);
  State(*this, reader);
  return reader.AtEnd();
}

RenderProgress ProgressiveSampling::Progress() const {
  RenderProgress progress;
  progress.rays = rays();
  progress.relative_error = worst_error_;
  for (std::size_t point = 0; point < blocks_.points(); ++point) {
    progress.samples = std::max(progress.samples, static_cast<double>(blocks_.blocks(point)));
  }
  progress.samples *= PointSampler::kBlockSamples;
  if (done()) {
    progress.fraction = 1;
    progress.remaining_seconds = 0;
    return progress;
  }
  if (!start_.has_value()) return progress;
  const double elapsed = Seconds(now_ - *start_).count();
  if (goal_.samples.has_value()) {
    progress.fraction =
        blocks_.total_blocks() / (static_cast<double>(most_blocks_) * static_cast<double>(blocks_.points()));
  }
  if (goal_.time_limit.has_value()) progress.fraction = std::max(progress.fraction, elapsed / *goal_.time_limit);
  if (goal_.target_error.has_value() && worst_error_.has_value() && *worst_error_ > 0) {
    const double ratio = *goal_.target_error / *worst_error_;
    progress.fraction = std::max(progress.fraction, std::min(ratio * ratio, 0.99));
  }
  progress.fraction = std::min(progress.fraction, 1.0);
  if (progress.fraction > 0) progress.remaining_seconds = elapsed * (1 - progress.fraction) / progress.fraction;
  return progress;
}

}  // namespace flatlight
