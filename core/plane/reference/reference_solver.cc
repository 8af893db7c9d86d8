// SPDX-License-Identifier: Apache-2.0
#include "core/plane/reference/reference_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/math/check.h"
#include "core/math/power.h"
#include "core/plane/reference/brightest_light.h"
#include "core/plane/reference/light_events.h"
#include "core/plane/reference/mesh_maker.h"
#include "core/plane/reference/quadrature.h"
#include "core/plane/reference/refinement.h"

namespace flatlight {
namespace {

constexpr std::size_t kRowParts = Radiosity::kRowParts;
// Light of n events, which have either sign, is as hard as that of about the root of n.
constexpr double kRootAtFirst = 4;
constexpr double kShortest = 1e-9;  // In the chart.
// Points whose error is at most so much of what is allowed have no say in what to split.
constexpr double kNear = 0.5;
constexpr std::size_t kPiecesPerThread = 4;
// To which equations are solved at first.
constexpr double kFirstTolerance = 1e-4;

// None: all, and so many that what is reflected more often is nothing beside rounding.
std::optional<std::uint32_t> MeaningfulBounces(const Scene& world, std::optional<std::uint32_t> bounces) {
  if (bounces == 0u || (bounces && UnitPower(world.traits().max_reflectance, *bounces) < 1e-20)) return std::nullopt;
  return bounces;
}

// Then there are no panels, nor anything that they would need.
bool IsDirectLight(const Scene& world, const ReferenceOptions& options) {
  return options.max_bounces == 0u || world.traits().max_reflectance == 0;
}

std::unique_ptr<SolvedWorld> NewWorld(std::shared_ptr<const RayCaster> caster, const ReferenceOptions& options) {
  auto world = std::make_unique<SolvedWorld>();
  world->caster = std::move(caster);
  const Scene& scene = world->caster->scene();
  world->charts = ChartsOf(scene);
  if (!IsDirectLight(scene, options)) world->meetings = Meetings(scene, world->charts);
  world->channels = static_cast<std::size_t>(options.channels);
  world->max_bounces = options.max_bounces;
  return world;
}

// How far ways over mirrors and through glass are followed at first; from panels, where arcs of Béziers have many,
// less.
constexpr double kFirstShare = 1e-6, kFirstShareOfBeziers = 1e-3;
constexpr std::size_t kMostSights = std::size_t{1} << 28;  // Bytes.

std::optional<SpecularViewOptions> SpecularOptions(const Scene& world, const ReferenceOptions& options) {
  if (IsDirectLight(world, options) || !HasSpecular(world)) return std::nullopt;
  SpecularViewOptions of_view;
  of_view.least_share = world.traits().has_beziers ? kFirstShareOfBeziers : kFirstShare;
  return of_view;
}

}  // namespace

// Working memory of a thread.
struct ReferenceSolver::Worker {
  Worker(const RayCaster& caster, const std::vector<Chart>& charts, const std::optional<SpecularViewOptions>& specular,
         const ExactOptions& options)
      : rows(caster, charts, specular),
        reception(caster, charts, specular),
        exact(caster.scene(), caster.bvh(), options) {}

  RowBuilder rows;
  Reception reception;
  ExactSolver exact;
  std::vector<double> shares, importance;  // Largest of the points it gathered, by panel.
};

ReferenceSolver::ReferenceSolver(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                                 const ReferenceOptions& options, std::unique_ptr<SolvedWorld> before)
    : scene_(std::move(scene)),
      options_(options),
      channels_(static_cast<std::size_t>(options.channels)),
      points_(*scene_, options.most_points),
      world_(before ? std::move(before) : NewWorld(std::move(caster), options)),
      tolerance_(std::clamp(kTolerance * options.target_error, kLeastTolerance, kTolerance)),
      coarse_tolerance_(world_->radiosity ? tolerance_ : std::max(tolerance_, kFirstTolerance)),
      lights_(*world_->caster, {.derivatives = options.derivatives}),
      specular_(SpecularOptions(world_->caster->scene(), options)) {
  direct_.resize(points_.receivers.size());
  has_direct_.resize(points_.receivers.size());
  relative_before_.resize(points_.receivers.size());
  idle_rounds_.resize(points_.receivers.size());
  dark_.resize(points_.receivers.size());
  goes_further_.resize(points_.receivers.size());
  if (specular_) {
    limits_.resize(points_.receivers.size());
    for (ViewLimit& limit : limits_) limit.least_share = kFirstShare;
  }
  const Scene& world = world_->caster->scene();
  if (world_->radiosity) {
    FLATLIGHT_DCHECK(world_->channels == channels_ && world_->max_bounces == options_.max_bounces);
    options_.max_bounces = MeaningfulBounces(world, options_.max_bounces);
    StartRound();
    after_direct_ = FirstOfPoints();
    return;
  }
  if (IsDirectLight(world, options_)) {
    options_.max_bounces.reset();
    world_->events.resize(2 * world.elements().size());
    StartMesh(PanelMesh(world.elements().size(), {}));
    after_direct_ = step_;
    step_ = Step::kDirect;
    return;
  }
  options_.max_bounces = MeaningfulBounces(world, options_.max_bounces);
  finder_.emplace(*world_->caster, world_->charts, world_->meetings);
  found_.resize(finder_->count());
}

ReferenceSolver::~ReferenceSolver() = default;

std::vector<ExactValue> ReferenceSolver::FirstValues() const {
  const Scene& world = world_->caster->scene();
  const bool reflects = world_->max_bounces != 0u && !IsDirectLight(world, options_);
  const Spectrum brightest = BrightestLight(world);
  std::vector<ExactValue> values = direct_;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!reflects && has_direct_[i] != 0) continue;
    values[i].irradiance_error = values[i].irradiance_error + 2 * brightest;
    if (has_direct_[i] == 0)
      values[i].irradiance_error = values[i].irradiance_error + LightsAt(world, *points_.receivers[i]);
    // Beside a lamp it is infinite, or no number.
    for (double& error : values[i].irradiance_error.value)
      if (!(error < kUnbounded)) error = kUnbounded;
    values[i].gradient_error = values[i].hessian_error = Spectrum::Grey(kUnbounded);
  }
  return values;
}

std::unique_ptr<SolvedWorld> ReferenceSolver::TakeWorld() {
  FLATLIGHT_DCHECK(state_ == State::kReached);
  return std::move(world_);
}

std::unique_ptr<ReferenceSolver::Worker> ReferenceSolver::Take() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Worker> worker = std::move(idle_.back());
      idle_.pop_back();
      return worker;
    }
  }
  return std::make_unique<Worker>(*world_->caster, world_->charts, specular_,
                                  ExactOptions{.derivatives = options_.derivatives, .channels = options_.channels});
}

void ReferenceSolver::Return(std::unique_ptr<Worker> worker) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(worker));
}

void ReferenceSolver::StartMesh(PanelMesh mesh) {
  if (new_rows_) idle_.clear();  // For others that follow ways further.
  world_->radiosity =
      std::make_unique<Radiosity>(*world_->caster, world_->charts, world_->events, std::move(mesh), channels_,
                                  options_.max_bounces, coarse_tolerance_, world_->radiosity.get());
  StartRound();
  step_ = Step::kRows;
}

void ReferenceSolver::StartRound() {
  coming_.assign(points_.receivers.size(), {});
  shares_.assign(panels(), 0.0);
  split_.assign(panels(), 0);
  places_.assign(panels(), {});
  next_ = 0;
  for (const auto& worker : idle_) worker->shares.clear(), worker->importance.clear();
}

void ReferenceSolver::StartFirstMesh() {
  const Scene& world = world_->caster->scene();
  world_->events = SortedEvents(world.elements().size(), found_);
  world_->kinks = SortedKinks(world.elements().size(), found_);
  finder_.reset();
  found_.clear();
  const PanelMesh between =
      SplitMeshAt(world, MeshBetween(world, world_->meetings), LightEvents(*world_->caster, world_->charts));
  std::vector<std::vector<double>> places(between.size());
  for (std::size_t i = 0; i < between.size(); ++i) {
    const Panel& panel = between.panels()[i];
    const std::vector<Event>& events = world_->events[PanelMesh::IndexOf(panel.element, panel.side)];
    const auto before = [](const Event& event, double u) { return event.u < u; };
    const auto low = std::lower_bound(events.begin(), events.end(), panel.low, before);
    const auto count = static_cast<std::size_t>(std::lower_bound(low, events.end(), panel.high, before) - low);
    const auto parts = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)) / kRootAtFirst) + 1;
    for (std::size_t k = 1; k < parts; ++k) {
      const double u = low[static_cast<std::ptrdiff_t>(k * count / parts)].u;
      if (u > (places[i].empty() ? panel.low : places[i].back()) + kShortest && u < panel.high - kShortest)
        places[i].push_back(u);
    }
  }
  StartMesh(SplitMesh(world, between, places));
}

std::size_t ReferenceSolver::Count() const {
  if (step_ == Step::kEvents) return found_.size();
  if (step_ == Step::kDirect || step_ == Step::kPoints) return points_.receivers.size();
  // Of what is seen over mirrors and through glass a single row is much work.
  if (step_ == Step::kRows && specular_) return panels() * kRowParts;
  return IsWhole() ? 1 : panels();
}

void ReferenceSolver::Advance(Executor& executor, int threads, const Cancellation& cancellation, const Clock& clock,
                              Clock::Duration budget) {
  const Clock::Time start = clock.Now();
  while (state_ == State::kWorks && !cancellation.cancelled()) {
    if (IsWhole()) {
      if (StepWhole(executor, threads)) next_ = 1;
    } else {
      const std::size_t left = Count() - next_;
      const std::size_t pieces = std::min(left, kPiecesPerThread * static_cast<std::size_t>(threads));
      const std::size_t lanes = std::min(pieces, static_cast<std::size_t>(threads));
      executor.ParallelFor(lanes, threads, [&](std::size_t lane) {
        std::unique_ptr<Worker> worker = Take();
        for (std::size_t i = lane; i < pieces; i += lanes) Work(*worker, next_ + i);
        Return(std::move(worker));
      });
      next_ += pieces;
    }
    if (next_ == Count()) NextStep();
    if (clock.Now() - start >= budget) return;
  }
}

bool ReferenceSolver::StepWhole(Executor& executor, int threads) {
  const Radiosity::Loop loop = [&](std::size_t count, const std::function<void(std::size_t)>& work) {
    // Of some panels at once, for a panel is little work.
    constexpr std::size_t kTogether = 8;
    executor.ParallelFor((count + kTogether - 1) / kTogether, threads, [&](std::size_t i) {
      for (std::size_t j = i * kTogether; j < std::min((i + 1) * kTogether, count); ++j) work(j);
    });
  };
  Radiosity& radiosity = *world_->radiosity;
  if (step_ == Step::kSolve) return radiosity.Solve(loop);
  return step_ == Step::kCorrect ? radiosity.Correct(loop) : radiosity.Bound(loop);
}

void ReferenceSolver::Work(Worker& worker, std::size_t i) {
  switch (step_) {
    case Step::kDirect:
      direct_[i] = worker.exact.Evaluate(*points_.receivers[i]);
      lights_.Add(*points_.receivers[i], direct_[i]);
      has_direct_[i] = 1;
      return;
    case Step::kEvents:
      return finder_->Find(i, found_[i]);
    case Step::kRows:
      if (specular_) return world_->radiosity->BuildRows(worker.rows, i / kRowParts, i % kRowParts);
      for (std::size_t part = 0; part < kRowParts; ++part) world_->radiosity->BuildRows(worker.rows, i, part);
      return;
    case Step::kCheck:
      return world_->radiosity->Check(i);
    case Step::kSpread:
      return world_->radiosity->Spread(i);
    case Step::kSlopes:
      return FindSlopes(worker, i);
    case Step::kPoints:
      return Gather(worker, i);
    case Step::kSplit: {
      const Panel& panel = world_->radiosity->mesh().panels()[i];
      const auto element = static_cast<std::size_t>(panel.element);
      if (!split_[i]) return;
      places_[i] = SplitPlaces(panel, world_->radiosity->CellsOf(i), world_->meetings[element],
                               world_->kinks[PanelMesh::IndexOf(panel.element, panel.side)]);
      return;
    }
    case Step::kSolve:
    case Step::kCorrect:
    case Step::kBound:
      return;
  }
}

void ReferenceSolver::FindSlopes(Worker& worker, std::size_t i) {
  const Panel& panel = world_->radiosity->mesh().panels()[i];
  const Chart& chart = world_->charts[static_cast<std::size_t>(panel.element)];
  if (specular_) return world_->radiosity->errors().GuessSlopes(chart, panel, i, channels_);
  for (const std::size_t k : {std::size_t{0}, kLightCoefficients / 2, kLightCoefficients - 1}) {
    const Receiver receiver = chart.ReceiverAt(panel.element, panel.At(Gauss(kLightCoefficients).node[k]), panel.side);
    const Received received = worker.reception.At(receiver, world_->radiosity->mesh(), world_->radiosity->light(),
                                                  &world_->radiosity->errors(), 1);
    for (std::size_t c = 0; c < channels_; ++c) {
      double& slope = world_->radiosity->errors().slope[i * channels_ + c];
      slope = std::max(slope, received.error[1].value[c] + received.rounding[1].value[c]);
    }
  }
}

void ReferenceSolver::Gather(Worker& worker, std::size_t point) {
  const Receiver& receiver = *points_.receivers[point];
  worker.shares.resize(panels(), 0.0);
  worker.importance.resize(panels(), 0.0);
  ExactValue value = direct_[point];
  std::optional<SpecularSight>* const sight = specular_ ? &limits_[point].sight : nullptr;
  const bool was_kept = sight != nullptr && sight->has_value();
  if (specular_) worker.reception.set_least_share(limits_[point].least_share);
  const Received received = worker.reception.At(receiver, world_->radiosity->mesh(), world_->radiosity->light(),
                                                &world_->radiosity->errors(), options_.derivatives, sight);
  if (sight != nullptr && !was_kept) {
    const std::size_t bytes = (*sight)->bytes();
    if (sight_bytes_.fetch_add(bytes) + bytes > kMostSights) {
      sight_bytes_.fetch_sub(bytes);
      sight->reset();
    }
  }
  Spectrum* const values[3] = {&value.irradiance, &value.gradient, &value.hessian};
  Spectrum* const errors[3] = {&value.irradiance_error, &value.gradient_error, &value.hessian_error};
  for (int m = 0; m <= options_.derivatives; ++m) {
    for (int c = 0; c < kMaxChannels; ++c) {
      const int from = c < options_.channels ? c : 0;
      (*values[m])[c] += received.value[m][from];
      (*errors[m])[c] += received.error[m][from] + received.rounding[m][from];
    }
  }
  if (specular_) limits_[point].unfollowed = received.unfollowed, limits_[point].indirect = received.indirect;
  // Light is not negative, even where its error is larger.
  double size = 0;
  for (int c = 0; c < kMaxChannels; ++c) {
    value.irradiance[c] = std::max(value.irradiance[c], 0.0);
    size = std::max({size, value.irradiance[c], value.irradiance_error[c]});
    if (!means_.empty()) size = std::max(size, kFloor * means_[points_.probes[point]][c]);
  }
  coming_[point] = value;
  // What comes no nearer to the target has no say in what to split.
  if (idle_rounds_[point] == kMostIdleRounds || (dark_waits_ && dark_[point] != 0)) return;
  const double allowed = options_.target_error * size;
  bool is_near = true;
  for (int c = 0; c < options_.channels; ++c) is_near = is_near && value.irradiance_error[c] <= kNear * allowed;
  for (const Reception::Share& share : worker.reception.shares()) {
    double& most = worker.shares[share.panel];
    most = std::max(most, Relative(share.of_residual, allowed));
    if (is_near) continue;
    double& importance = worker.importance[share.panel];
    importance = std::max(importance, Relative(share.weight, allowed));
  }
}

void ReferenceSolver::CollectShares(std::vector<double>& importance) {
  for (const auto& worker : idle_) {
    for (std::size_t i = 0; i < worker->shares.size(); ++i) {
      shares_[i] = std::max(shares_[i], worker->shares[i]);
      importance[i] = std::max(importance[i], worker->importance[i]);
    }
  }
}

void ReferenceSolver::NextStep() {
  next_ = 0;
  if (step_ == Step::kDirect) {
    step_ = after_direct_;
    return;
  }
  if (step_ == Step::kEvents) return StartFirstMesh();
  if (step_ == Step::kPoints) return EndPoints();
  if (step_ == Step::kSplit) return StartMesh(SplitMesh(world_->caster->scene(), world_->radiosity->mesh(), places_));
  step_ = static_cast<Step>(static_cast<int>(step_) + 1);
  if (step_ == Step::kSlopes) step_ = FirstOfPoints();
}

}  // namespace flatlight
