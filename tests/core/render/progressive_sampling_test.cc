// SPDX-License-Identifier: Apache-2.0
#include "core/render/progressive_sampling.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "core/sampling/hash.h"
#include "core/sampling/sample_stream.h"
#include "tests/support/transport/honest_errors.h"

namespace flatlight {
namespace {

constexpr Clock::Duration kForever = Clock::Duration::max();

// Stands still but for what a test or its work adds.
class ManualClock final : public Clock {
 public:
  Time Now() const override { return Time(Duration(nanoseconds_.load())); }
  void Advance(Duration duration) { nanoseconds_ += duration.count(); }

 private:
  std::atomic<Duration::rep> nanoseconds_ = 0;
};

// A source that calls add(block, sums, rays).
template <typename Add>
std::unique_ptr<const PointSampler::Source> SourceOf(Add add) {
  class Added final : public PointSampler::Source {
   public:
    explicit Added(Add a) : add_(std::move(a)) {}
    void AddBlock(std::uint32_t block, const Cancellation&, std::span<double> sums, double& rays) const override {
      add_(block, sums, rays);
    }

   private:
    Add add_;
  };
  return std::make_unique<Added>(std::move(add));
}

// Uniform numbers around 1 + point; each block takes some time of a manual clock.
class UniformSampler final : public PointSampler {
 public:
  explicit UniformSampler(ManualClock* clock = nullptr, Clock::Duration block_time = {})
      : clock_(clock), block_time_(block_time) {}
  std::size_t channels() const override { return 1; }
  void Doubts(std::size_t, std::span<Doubt> doubts) const override { doubts[0] = {}; }
  std::unique_ptr<const Source> At(std::size_t point) const override {
    return SourceOf([this, point](std::uint32_t block, std::span<double> sums, double& rays) {
      for (std::size_t r = 0; r < kReplicates; ++r) {
        sums[r] += static_cast<double>(point) + 2 * ToUnitInterval(ChildKey(ChildKey(point, block), r));
      }
      rays += kReplicates;
      if (clock_ != nullptr) clock_->Advance(block_time_);
    });
  }

 private:
  ManualClock* clock_;
  Clock::Duration block_time_;
};

std::vector<double> Samples(const ProgressiveSampling& sampling, std::size_t points) {
  std::vector<double> samples;
  for (const ProgressiveSampling::PointValue& value : sampling.Values()) samples.push_back(value.samples);
  EXPECT_EQ(samples.size(), points);
  return samples;
}

TEST(ProgressiveSamplingTest, FirstEveryPointGetsOneBlock) {
  ManualClock clock;
  SamplingGoal goal;
  goal.samples = 1000;
  ProgressiveSampling sampling(std::make_unique<UniformSampler>(&clock, std::chrono::milliseconds(1)), {3, 5}, goal);
  InlineExecutor executor;
  const Cancellation never;
  EXPECT_EQ(Samples(sampling, 5), std::vector<double>(5, 0));
  EXPECT_EQ(sampling.Progress().fraction, 0);
  for (int slice = 0; slice < 5; ++slice) sampling.Advance(executor, 1, never, clock, Clock::Duration(0));
  EXPECT_EQ(Samples(sampling, 5), std::vector<double>(5, 16));
  EXPECT_FALSE(sampling.done());
  sampling.Advance(executor, 1, never, clock, kForever);
  ASSERT_TRUE(sampling.done());
  EXPECT_EQ(sampling.end_reason(), EndReason::kSamplesDone);
  EXPECT_EQ(Samples(sampling, 5), std::vector<double>(5, 1008));
  EXPECT_EQ(sampling.Progress().fraction, 1);
  EXPECT_EQ(sampling.rays(), 5 * 1008);
  EXPECT_NEAR(sampling.Values()[4].estimates[0].mean, 5, 6 * sampling.Values()[4].estimates[0].StandardError());
}

TEST(ProgressiveSamplingTest, BudgetsAreKept) {
  ManualClock clock;
  SamplingGoal goal;
  goal.samples = 1 << 20;
  ProgressiveSampling sampling(std::make_unique<UniformSampler>(&clock, std::chrono::microseconds(50)), {10}, goal);
  InlineExecutor executor;
  const Cancellation never;
  for (int slice = 0; slice < 20; ++slice) {
    const Clock::Time before = clock.Now();
    sampling.Advance(executor, 1, never, clock, std::chrono::milliseconds(20));
    EXPECT_LE(clock.Now() - before, std::chrono::milliseconds(23));
    EXPECT_GE(clock.Now() - before, std::chrono::milliseconds(20));
  }
}

// Backwards, and with a pause now and then: what comes first in order comes too late.
class BackwardExecutor final : public Executor {
 public:
  explicit BackwardExecutor(ManualClock& clock) : clock_(clock) {}
  int threads() const override { return 2; }
  void ParallelFor(std::size_t count, int /*max_threads*/, const std::function<void(std::size_t)>& work) override {
    for (std::size_t i = count; i > 0; --i) {
      if (++calls_ % 7 == 0) clock_.Advance(std::chrono::milliseconds(5));
      work(i - 1);
    }
  }

 private:
  ManualClock& clock_;
  int calls_ = 0;
};

TEST(ProgressiveSamplingTest, RaysOfWorkThatIsDoneAgainCountOnce) {
  ManualClock clock;
  SamplingGoal goal;
  goal.samples = 100'000;
  ProgressiveSampling sampling(std::make_unique<UniformSampler>(&clock, std::chrono::microseconds(100)), {3}, goal);
  BackwardExecutor executor(clock);
  const Cancellation never;
  while (!sampling.done()) sampling.Advance(executor, 2, never, clock, std::chrono::milliseconds(7));
  EXPECT_EQ(sampling.rays(), 3 * 100'000);
}

TEST(ProgressiveSamplingTest, TimeLimitEndsAtEqualCountsAndInTime) {
  for (const double limit : {0.05, 0.5, 3.0}) {
    ManualClock clock;
    SamplingGoal goal;
    goal.time_limit = limit;
    ProgressiveSampling sampling(std::make_unique<UniformSampler>(&clock, std::chrono::microseconds(100)), {40}, goal);
    InlineExecutor executor;
    const Cancellation never;
    while (!sampling.done()) {
      sampling.Advance(executor, 1, never, clock, std::chrono::milliseconds(5));
      EXPECT_LE(sampling.Progress().fraction, 1);
    }
    EXPECT_EQ(sampling.end_reason(), EndReason::kTimeLimit);
    const double seconds = std::chrono::duration<double>(clock.Now().time_since_epoch()).count();
    EXPECT_LE(seconds, limit);
    EXPECT_GE(seconds, limit - 0.005) << "the last block of all points takes 4 ms";
    EXPECT_EQ(Samples(sampling, 40), std::vector<double>(40, sampling.Values()[0].samples));
  }
}

// The limit ends the first round as any other: points that had no turn have no samples, those that had one are the same
// as ever.
TEST(ProgressiveSamplingTest, TimeLimitEndsTheFirstRound) {
  ManualClock clock;
  SamplingGoal goal;
  goal.time_limit = 2.5;
  ProgressiveSampling sampling(std::make_unique<UniformSampler>(&clock, std::chrono::seconds(1)), {4, 10}, goal);
  InlineExecutor executor;
  const Cancellation never;
  while (!sampling.done()) sampling.Advance(executor, 1, never, clock, std::chrono::milliseconds(10));
  EXPECT_EQ(sampling.end_reason(), EndReason::kTimeLimit);
  EXPECT_EQ(Samples(sampling, 10), (std::vector<double>{16, 16, 16, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(sampling.Progress().fraction, 1);
  EXPECT_FALSE(sampling.Progress().relative_error.has_value());
  goal.time_limit.reset();
  goal.samples = 16;
  ProgressiveSampling whole(std::make_unique<UniformSampler>(), {4, 10}, goal);
  whole.Advance(executor, 1, never, clock, kForever);
  for (std::size_t point = 0; point < 3; ++point)
    EXPECT_EQ(sampling.Values()[point].estimates[0].mean, whole.Values()[point].estimates[0].mean);
}

// Blocks that take longer and longer: the plan of the round is off, the limit is not.
TEST(ProgressiveSamplingTest, TimeLimitEndsARoundThatTakesLongerThanPlanned) {
  ManualClock clock;
  class SlowingSampler final : public PointSampler {
   public:
    explicit SlowingSampler(ManualClock& clock) : clock_(clock) {}
    std::size_t channels() const override { return 1; }
    void Doubts(std::size_t, std::span<Doubt> doubts) const override { doubts[0] = {}; }
    std::unique_ptr<const Source> At(std::size_t) const override {
      return SourceOf([this](std::uint32_t block, std::span<double>, double&) {
        clock_.Advance(block < 4 ? std::chrono::milliseconds(1) : std::chrono::milliseconds(500));
      });
    }

   private:
    ManualClock& clock_;
  };
  SamplingGoal goal;
  goal.time_limit = 2;
  ProgressiveSampling sampling(std::make_unique<SlowingSampler>(clock), {20}, goal);
  InlineExecutor executor;
  const Cancellation never;
  while (!sampling.done()) sampling.Advance(executor, 1, never, clock, std::chrono::milliseconds(10));
  EXPECT_EQ(sampling.end_reason(), EndReason::kTimeLimit);
  EXPECT_LE(std::chrono::duration<double>(clock.Now().time_since_epoch()).count(), 2.5) << "a block more at most";
  EXPECT_TRUE(sampling.Progress().relative_error.has_value());
}

// Points of larger mean meet the relative target with fewer samples; all counts are 64 times powers of two.
TEST(ProgressiveSamplingTest, TargetErrorStopsPointByPoint) {
  ManualClock clock;
  SamplingGoal goal;
  goal.target_error = 0.005;
  ProgressiveSampling sampling(std::make_unique<UniformSampler>(), {30}, goal);
  InlineExecutor executor;
  const Cancellation never;
  sampling.Advance(executor, 1, never, clock, kForever);
  ASSERT_TRUE(sampling.done());
  EXPECT_EQ(sampling.end_reason(), EndReason::kTargetReached);
  EXPECT_GT(sampling.Values()[0].samples, 4 * sampling.Values()[29].samples);
  for (std::size_t p = 0; p < 30; ++p) {
    EXPECT_GE(sampling.Values()[p].samples, 64);
    const MeanEstimate estimate = sampling.Values()[p].estimates[0];
    EXPECT_LE(estimate.StandardError(), 0.005 * estimate.mean);
  }
  EXPECT_LE(*sampling.Progress().relative_error, 0.005);
}

// Independent samples of one distribution at every point, made of uniform numbers.
class DrawnSampler final : public PointSampler {
 public:
  using Draw = double (*)(double);
  DrawnSampler(std::uint64_t seed, Draw draw, double brightest) : seed_(seed), draw_(draw), brightest_(brightest) {}
  std::size_t channels() const override { return 1; }
  void Doubts(std::size_t, std::span<Doubt> doubts) const override { doubts[0] = {0, brightest_, 0}; }
  std::unique_ptr<const Source> At(std::size_t point) const override {
    return SourceOf([this, point](std::uint32_t block, std::span<double> sums, double&) {
      for (std::size_t r = 0; r < kReplicates; ++r) {
        sums[r] += draw_(ToUnitInterval(ChildKey(ChildKey(ChildKey(seed_, point), block), r)));
      }
    });
  }

 private:
  std::uint64_t seed_;
  Draw draw_;
  double brightest_;
};

struct Distribution {
  const char* name;
  DrawnSampler::Draw draw;
  double mean;
  double brightest;  // As the sampler knows it.
  double target;
};

const Distribution kDistributions[] = {
    {"two values", [](double u) { return u < 0.5 ? 0.5 : 1.5; }, 1, 1, 0.05},
    {"exponential", [](double u) { return -std::log(1 - u); }, 1, 5, 0.1},
    {"rare", [](double u) { return u < 0.02 ? 1.0 : 0.0; }, 0.02, 1, 0.2},
    {"rare on a ground", [](double u) { return u < 0.02 ? 21.0 : 1.0; }, 1.4, 20, 0.1},
    {"rare on a ground, coarsely", [](double u) { return u < 0.02 ? 21.0 : 1.0; }, 1.4, 20, 0.3},
    {"very rare and bright", [](double u) { return u < 0.005 ? 101.0 : 1.0; }, 1.5, 100, 0.2},
};

HonestErrors ErrorsAtTheStop(const Distribution& distribution, std::size_t points, std::uint64_t runs, double factor) {
  ManualClock clock;
  SamplingGoal goal;
  goal.target_error = distribution.target;
  InlineExecutor executor;
  const Cancellation never;
  HonestErrors errors;
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    ProgressiveSampling sampling(std::make_unique<DrawnSampler>(seed, distribution.draw, distribution.brightest),
                                 {points}, goal);
    sampling.Advance(executor, 1, never, clock, kForever);
    EXPECT_EQ(sampling.end_reason(), EndReason::kTargetReached);
    const std::vector<ProgressiveSampling::PointValue> values = sampling.Values();
    for (const ProgressiveSampling::PointValue& value : values) {
      const MeanEstimate& estimate = value.estimates[0];
      EXPECT_LE(estimate.StandardError(), distribution.target * estimate.mean);
      errors.Add(factor * estimate.mean, distribution.mean, estimate.StandardError());
    }
  }
  return errors;
}

// Where sampling stops by itself, for single points and for rows of them: z has mean square 1 within what the number of
// runs allows. Skewed samples have skewed z of a mean below 0, so the mean of the values themselves is tested for bias.
TEST(ProgressiveSamplingTest, StatedErrorsTellTheTruthAtTheStop) {
  for (const Distribution& distribution : kDistributions) {
    SCOPED_TRACE(distribution.name);
    const HonestErrors single = ErrorsAtTheStop(distribution, 1, 1000, 1);
    EXPECT_TRUE(single.RightSize()) << single.MeanSquareZ();
    const HonestErrors row = ErrorsAtTheStop(distribution, 40, 25, 1);
    EXPECT_TRUE(row.RightSize()) << row.MeanSquareZ();
  }
}

// Means over 1000 runs: beyond 5 of their standard deviations with probability 6e-7. The same test notices what is
// wrong by one target error in four.
TEST(ProgressiveSamplingTest, TargetErrorIsMetWithoutBias) {
  for (const Distribution& distribution : kDistributions) {
    SCOPED_TRACE(distribution.name);
    ManualClock clock;
    SamplingGoal goal;
    goal.target_error = distribution.target;
    InlineExecutor executor;
    const Cancellation never;
    double sum = 0;
    double squares = 0;
    constexpr int kRuns = 1000;
    for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
      ProgressiveSampling sampling(std::make_unique<DrawnSampler>(seed, distribution.draw, distribution.brightest), {1},
                                   goal);
      sampling.Advance(executor, 1, never, clock, kForever);
      const double difference = sampling.Values()[0].estimates[0].mean - distribution.mean;
      sum += difference;
      squares += difference * difference;
    }
    EXPECT_LT(std::abs(sum), 5 * std::sqrt(squares)) << sum / kRuns;
    const double wrong = sum + kRuns * 0.25 * distribution.target * distribution.mean;
    EXPECT_GT(std::abs(wrong), 5 * std::sqrt(squares));
  }
}

// Points that have met no bright sample by 64 do not stop for it: neighbours have.
TEST(ProgressiveSamplingTest, NeighboursTellOfRareSamples) {
  ManualClock clock;
  SamplingGoal goal;
  goal.target_error = 0.2;
  InlineExecutor executor;
  const Cancellation never;
  const Distribution& rare = kDistributions[5];
  ProgressiveSampling sampling(std::make_unique<DrawnSampler>(1, rare.draw, rare.brightest), {200}, goal);
  sampling.Advance(executor, 1, never, clock, kForever);
  // One sample of 100 must move the mean by no more than a quarter of the target: 1333 samples where the mean is found
  // to be 1.5.
  for (const double samples : Samples(sampling, 200)) EXPECT_GE(samples, 1333 / 2);
}

// The part of [0, 1) below an edge, at another place for every point.
class EdgeSampler final : public PointSampler {
 public:
  EdgeSampler(std::uint64_t seed, bool shared) : seed_(seed), shared_(shared) {}
  static double Edge(std::size_t point) { return 0.2 + 0.6 * ToUnitInterval(ChildKey(1, point)); }
  std::size_t channels() const override { return 1; }
  void Doubts(std::size_t, std::span<Doubt> doubts) const override { doubts[0] = {1, 0, 0}; }
  std::unique_ptr<const Source> At(std::size_t point) const override {
    return SourceOf([this, point](std::uint32_t block, std::span<double> sums, double&) {
      for (std::uint32_t r = 0; r < kReplicates; ++r) {
        const SampleStream stream =
            shared_ ? SampleStream::Member(seed_, point, r / SampleStream::kMembers, r % SampleStream::kMembers)
                    : SampleStream(seed_, point, r);
        sums[r] += stream.Pair(block, 0).u < Edge(point) ? 1 : 0;
      }
    });
  }

 private:
  std::uint64_t seed_;
  bool shared_;
};

struct EdgeErrors {
  HonestErrors errors;
  double mean_square = 0;
};

EdgeErrors ErrorsAtEdges(bool shared, std::size_t points, std::uint64_t runs, const SamplingGoal& goal) {
  ManualClock clock;
  InlineExecutor executor;
  const Cancellation never;
  EdgeErrors edges;
  const auto count = static_cast<double>(points * runs);
  for (std::uint64_t seed = 0; seed < runs; ++seed) {
    ProgressiveSampling sampling(std::make_unique<EdgeSampler>(seed, shared), {points}, goal);
    sampling.Advance(executor, 1, never, clock, kForever);
    const std::vector<ProgressiveSampling::PointValue> values = sampling.Values();
    for (std::size_t point = 0; point < points; ++point) {
      const MeanEstimate& estimate = values[point].estimates[0];
      const double off = estimate.mean - EdgeSampler::Edge(point);
      edges.errors.Add(estimate.mean, EdgeSampler::Edge(point), estimate.StandardError());
      edges.mean_square += off * off / count;
    }
  }
  return edges;
}

// Replicates that share sequences place an edge eight times as sharply, in variance. The error that is stated knows of
// it: by replicates alone z^2 would be an eighth. (It is told somewhat too large, for where few replicates are beyond
// an edge the halves differ by more than the mean is off.)
TEST(ProgressiveSamplingTest, SharedSequencesPlaceEdgesSharply) {
  SamplingGoal goal;
  for (const std::uint32_t samples : {64u, 256u, 1024u}) {
    SCOPED_TRACE(samples);
    goal.samples = samples;
    const EdgeErrors shared = ErrorsAtEdges(true, 129, 60, goal), apart = ErrorsAtEdges(false, 129, 60, goal);
    EXPECT_GT(apart.mean_square / shared.mean_square, 6);
    EXPECT_LT(apart.mean_square / shared.mean_square, 10);
    EXPECT_GT(shared.errors.MeanSquareZ(), 0.5);
    EXPECT_LT(shared.errors.MeanSquareZ(), 1.1);
    EXPECT_GT(apart.errors.MeanSquareZ(), 0.9);
    EXPECT_LT(apart.errors.MeanSquareZ(), 1.2);
  }
}

// Where points stop by themselves too, and alone.
TEST(ProgressiveSamplingTest, ErrorsAtEdgesAreNotTooSmallAtTheStop) {
  SamplingGoal goal;
  goal.target_error = 0.02;
  const EdgeErrors row = ErrorsAtEdges(true, 129, 60, goal);
  EXPECT_GT(row.errors.MeanSquareZ(), 0.3);
  EXPECT_LT(row.errors.MeanSquareZ(), 1.1);
  EXPECT_LT(ErrorsAtEdges(true, 1, 1000, goal).errors.MeanSquareZ(), 1.1);
}

TEST(ProgressiveSamplingTest, NoPointsMeansNoWork) {
  ManualClock clock;
  SamplingGoal goal;
  goal.samples = 16;
  ProgressiveSampling sampling(std::make_unique<UniformSampler>(), {}, goal);
  InlineExecutor executor;
  const Cancellation never;
  sampling.Advance(executor, 1, never, clock, kForever);
  EXPECT_TRUE(sampling.done());
}

}  // namespace
}  // namespace flatlight
