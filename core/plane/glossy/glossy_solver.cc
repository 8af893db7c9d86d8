// SPDX-License-Identifier: Apache-2.0
#include "core/plane/glossy/glossy_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <variant>

#include "core/math/check.h"
#include "core/math/tolerances.h"
#include "core/plane/glossy/incoming.h"
#include "core/plane/glossy/scatter_row.h"
#include "core/plane/reference/brightest_light.h"
#include "core/plane/reference/error_sum.h"
#include "core/plane/reference/light_events.h"
#include "core/plane/reference/mesh_maker.h"
#include "core/plane/reference/refinement.h"
#include "core/plane/reference/row.h"

namespace flatlight {
namespace {

// Decimal digits of integrals of the equations, and of those that check them.
constexpr int kDigits = 9;
constexpr int kCheckDigits = 12;
constexpr double kRounding = 64 * kUnitRoundoff;
// The brightest light in sight is known on rays only.
constexpr double kBrighter = 2;
constexpr int kMostRounds = 24;
constexpr std::size_t kMostMemory = std::size_t{1} << 30;
// A round that brings the error down by less than this is idle.
constexpr double kIdle = 0.9;
constexpr int kMostIdleRounds = 3;
// An error that is larger yet tells nothing: there is no light.
constexpr double kFarthest = 1e6;
constexpr std::size_t kPiecesPerThread = 4;
// To which equations are solved: of the target error; after an idle round; and at least.
constexpr double kTolerance = 1e-3;
constexpr double kTighter = 1e-2;
constexpr double kLeastTolerance = 1e-14;
// Of what is allowed in all, for cells that stay; and cells with so much less than the worst stay, too.
constexpr double kLeft = 0.3;
constexpr double kWaits = 3e-3;
// A cell is split as many times at once as it has more to lose, for each time brings it down by about so much; and at
// most so often.
constexpr double kPerSplit = 256;
constexpr int kMostTimes = 3;
constexpr double kFewer = 8;

// Cells with no larger a share need no split.
double LargestToStay(std::vector<double> shares) {
  std::sort(shares.begin(), shares.end());
  const double allowed = kLeft * std::min(1.0, std::accumulate(shares.begin(), shares.end(), 0.0));
  double stays = 0, sum = 0;
  for (const double share : shares) {
    sum += share;
    if (sum <= allowed || share <= kWaits * shares.back()) stays = share;
  }
  return stays;
}

}  // namespace

bool IsGlossy(const Scene& scene) {
  if (scene.traits().has_beziers) return false;
  bool glossy = false;
  for (const Curve& curve : scene.curves()) {
    if (curve.reflectance.IsBlack() || std::holds_alternative<Lambertian>(curve.material)) continue;
    if (!GlossyLobe::Of(curve.material)) return false;
    glossy = true;
  }
  return glossy;
}

// Working memory of a thread.
struct GlossySolver::Worker {
  Worker(const RayCaster& caster, const std::vector<Chart>& charts)
      : rows(caster, charts, kDigits),
        checks(caster, charts, kCheckDigits),
        incoming(caster, charts, kCheckDigits),
        end_errors(caster.scene()),
        exact(caster.scene(), caster.bvh(), {.derivatives = 0}) {}

  ScatterRowBuilder rows, checks;
  Incoming incoming;
  EndErrors end_errors;
  ExactSolver exact;
  // By channel, then cell: how much an error of one there counts at a point, at most of those it gathered.
  std::vector<std::vector<double>> importance;
  std::vector<double> seen;   // By cell.
  std::vector<double> known;  // By channel, then cell: what comes of residuals.
};

GlossySolver::GlossySolver(std::shared_ptr<const Scene> scene, std::shared_ptr<const RayCaster> caster,
                           const ReferenceOptions& options)
    : scene_(std::move(scene)),
      caster_(std::move(caster)),
      world_(caster_->scene()),
      options_(options),
      channels_(static_cast<std::size_t>(options.channels)),
      points_(*scene_, options.most_points),
      charts_(ChartsOf(world_)),
      meetings_(Meetings(world_, charts_)),
      lights_(*caster_, {.derivatives = 0}),
      tolerance_(std::clamp(kTolerance * options.target_error, kLeastTolerance, kTolerance)) {
  FLATLIGHT_DCHECK(options_.derivatives == 0 && !options_.max_bounces);
  direct_.resize(points_.receivers.size());
  finder_.emplace(*caster_, charts_, meetings_);
  found_.resize(finder_->count());
}

GlossySolver::~GlossySolver() = default;

std::vector<ExactValue> GlossySolver::FirstValues() const {
  // A lobe may throw all light of a lamp without a surface into a narrow cone.
  const Spectrum brightest = world_.lights().empty() ? BrightestLight(world_) : Spectrum::Grey(kUnbounded);
  std::vector<ExactValue> values = direct_;
  for (ExactValue& value : values) {
    value.irradiance_error = value.irradiance_error + 2 * brightest;
    for (double& error : value.irradiance_error.value)
      if (!(error < kUnbounded)) error = kUnbounded;
  }
  return values;
}

std::unique_ptr<GlossySolver::Worker> GlossySolver::Take() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Worker> worker = std::move(idle_.back());
      idle_.pop_back();
      return worker;
    }
  }
  return std::make_unique<Worker>(*caster_, charts_);
}

void GlossySolver::Return(std::unique_ptr<Worker> worker) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(worker));
}

std::size_t GlossySolver::Count() const {
  if (step_ == Step::kEvents) return found_.size();
  if (step_ == Step::kDirect || step_ == Step::kPoints) return points_.receivers.size();
  return IsWhole() ? 1 : radiosity_->mesh().panels().size();
}

void GlossySolver::Advance(Executor& executor, int threads, const Cancellation& cancellation, const Clock& clock,
                           Clock::Duration budget) {
  const Clock::Time start = clock.Now();
  while (state_ == State::kWorks && !cancellation.cancelled()) {
    if (IsWhole()) {
      if (StepWhole(executor, threads)) next_ = 1;
    } else {
      const std::size_t pieces = std::min(Count() - next_, kPiecesPerThread * static_cast<std::size_t>(threads));
      const std::size_t lanes = std::min(pieces, static_cast<std::size_t>(threads));
      executor.ParallelFor(lanes, threads, [&](std::size_t lane) {
        std::unique_ptr<Worker> worker = Take();
        for (std::size_t i = lane; i < pieces; i += lanes) Work(*worker, next_ + i);
        Return(std::move(worker));
      });
      next_ += pieces;
    }
    if (step_ == Step::kRows && radiosity_->memory() > kMostMemory) {
      state_ = State::kExhausted;
      return;
    }
    if (next_ == Count()) NextStep();
    if (clock.Now() - start >= budget) return;
  }
}

bool GlossySolver::StepWhole(Executor& executor, int threads) {
  const GlossyRadiosity::Loop loop = [&](std::size_t count, const std::function<void(std::size_t)>& work) {
    executor.ParallelFor(count, threads, work);
  };
  return step_ == Step::kSolve ? radiosity_->Solve(loop) : radiosity_->Bound(loop);
}

void GlossySolver::Work(Worker& worker, std::size_t i) {
  switch (step_) {
    case Step::kDirect:
      direct_[i] = worker.exact.Evaluate(*points_.receivers[i]);
      lights_.Add(*points_.receivers[i], direct_[i]);
      return;
    case Step::kEvents:
      return finder_->Find(i, found_[i]);
    case Step::kRows:
      return radiosity_->Build(worker.rows, i);
    case Step::kCheck:
      return radiosity_->Check(worker.checks, i);
    case Step::kSpread:
      return radiosity_->Spread(i);
    case Step::kPoints:
      return Gather(worker, i);
    case Step::kSolve:
    case Step::kBound:
      return;
  }
}

double GlossySolver::SizeAt(const ExactValue& value, std::size_t point, int channel) const {
  const double floor = means_.empty() ? 0 : kFloor * means_[points_.probes[point]][channel];
  return std::max(value.irradiance[channel], floor);
}

void GlossySolver::Gather(Worker& worker, std::size_t point) {
  const std::size_t cells = radiosity_->mesh().cells().size();
  worker.importance.resize(channels_);
  for (auto& of_channel : worker.importance) of_channel.resize(cells, 0.0);
  worker.seen.assign(cells, 0.0);
  worker.known.assign(channels_ * cells, 0.0);
  worker.incoming.From(*points_.receivers[point], radiosity_->mesh(), false, std::numbers::pi);
  Spectrum reflected, error, brightest;
  for (const IncomingRay& ray : worker.incoming.rays()) {
    if (ray.cell == IncomingRay::kNoCell) continue;
    const double weight = ray.weight * ray.in.cosine;
    worker.seen[ray.cell] += weight;
    for (std::size_t c = 0; c < channels_; ++c) {
      const double light = radiosity_->light(c).At(ray.cell, ray.x, ray.y);
      reflected.value[c] += weight * light;
      brightest.value[c] = std::max(brightest.value[c], std::abs(light));
      worker.known[c * cells + ray.cell] += weight * radiosity_->residual(c).At(ray.cell, ray.x, ray.y);
    }
  }
  double coordinates = 0;
  for (const VisiblePiece& piece : worker.incoming.pieces()) {
    if (world_.curve_of(piece.element).reflectance.IsBlack()) continue;
    for (const PieceEnd* end : {&piece.begin, &piece.end})
      coordinates += worker.end_errors.Add(*points_.receivers[point], piece.element, *end, 1).s;
  }
  for (std::size_t c = 0; c < channels_; ++c) {
    ErrorSum of_residuals;
    for (std::size_t i = 0; i < cells; ++i) {
      if (!(worker.seen[i] > 0)) continue;
      of_residuals.Add(worker.known[c * cells + i], worker.seen[i] * radiosity_->missed(c)[i]);
      error.value[c] += worker.seen[i] * radiosity_->bound(c)[i];
    }
    error.value[c] += GlossyRadiosity::kBetween * of_residuals.known() + of_residuals.missed();
    error.value[c] += kBrighter * coordinates * brightest.value[c] + kRounding * std::abs(reflected.value[c]);
  }
  ExactValue value = direct_[point];
  for (int c = 0; c < kMaxChannels; ++c) {
    const int from = c < options_.channels ? c : 0;
    value.irradiance[c] = std::max(value.irradiance[c] + reflected[from], 0.0);
    value.irradiance_error[c] = std::min(value.irradiance_error[c] + error[from], kUnbounded);
  }
  coming_[point] = value;
  for (std::size_t c = 0; c < channels_; ++c) {
    const double size = std::max(SizeAt(value, point, static_cast<int>(c)), value.irradiance_error.value[c]);
    if (!(size > 0) || !(value.irradiance_error.value[c] > options_.target_error * size)) continue;
    for (std::size_t i = 0; i < cells; ++i) {
      double& most = worker.importance[c][i];
      most = std::max(most, worker.seen[i] / (options_.target_error * size));
    }
  }
}

void GlossySolver::NextStep() {
  next_ = 0;
  if (step_ == Step::kEvents) return StartFirstMesh();
  if (step_ == Step::kPoints) return EndPoints();
  step_ = static_cast<Step>(static_cast<int>(step_) + 1);
  if (step_ == Step::kSpread) radiosity_->EndCheck();
  if (step_ == Step::kPoints) coming_.assign(points_.receivers.size(), {});
}

void GlossySolver::StartFirstMesh() {
  const std::size_t elements = world_.elements().size();
  kinks_ = SortedKinks(elements, found_);
  finder_.reset();
  found_.clear();
  PanelMesh panels = SplitMeshAt(world_, MeshBetween(world_, meetings_), LightEvents(*caster_, charts_));
  std::vector<CellMesh::Borders> borders;
  for (const Panel& panel : panels.panels())
    borders.push_back(FirstBorders(GlossyLobe::Of(world_.curve_of(panel.element).material)));
  StartMesh(CellMesh(world_, std::move(panels), borders), {});
}

void GlossySolver::StartMesh(CellMesh mesh, std::vector<std::vector<double>> start) {
  radiosity_ = std::make_unique<GlossyRadiosity>(world_, std::move(mesh), channels_, tolerance_, std::move(start));
  for (const auto& worker : idle_) worker->importance.clear();
  step_ = Step::kRows;
  next_ = 0;
}

void GlossySolver::EndPoints() {
  means_ = points_.Means(coming_);
  values_.swap(coming_);
  const double before = relative_error_;
  relative_error_ = 0;
  for (std::size_t i = 0; i < points_.receivers.size(); ++i)
    for (int c = 0; c < options_.channels; ++c)
      relative_error_ = std::max(relative_error_, Relative(values_[i].irradiance_error[c], SizeAt(values_[i], i, c)));
  if (rounds_++ == 0) first_relative_error_ = relative_error_;
  if (relative_error_ <= options_.target_error) {
    state_ = State::kReached;
    return;
  }
  if (rounds_ > 1 && relative_error_ > kIdle * before) {
    tolerance_ = std::max(kTighter * tolerance_, kLeastTolerance);
    ++idle_rounds_;
  } else {
    idle_rounds_ = 0;
  }
  if (rounds_ == kMostRounds || idle_rounds_ == kMostIdleRounds) {
    state_ = State::kExhausted;
    return;
  }
  Refine();
}

void GlossySolver::SplitTimes(const Panel& panel, int times, std::vector<double>& places) const {
  if (times == 0) return;
  const std::vector<double> own = SplitPlaces(panel, {}, meetings_[static_cast<std::size_t>(panel.element)],
                                              kinks_[PanelMesh::IndexOf(panel.element, panel.side)]);
  Panel part = panel;
  for (std::size_t k = 0; k <= own.size() && !own.empty(); ++k) {
    part.high = k < own.size() ? own[k] : panel.high;
    SplitTimes(part, times - 1, places);
    if (k < own.size()) places.push_back(own[k]);
    part.low = part.high;
  }
}

void GlossySolver::Refine() {
  const CellMesh& mesh = radiosity_->mesh();
  std::vector<double> shares(mesh.cells().size(), 0.0), direct(mesh.cells().size());
  for (std::size_t c = 0; c < channels_; ++c) {
    std::fill(direct.begin(), direct.end(), 0.0);
    for (const auto& worker : idle_)
      if (c < worker->importance.size())
        for (std::size_t i = 0; i < direct.size(); ++i) direct[i] = std::max(direct[i], worker->importance[c][i]);
    const std::vector<double> of_channel = radiosity_->Shares(c, direct);
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = std::max(shares[i], of_channel[i]);
  }
  // Residuals have either sign: what they come to is far less than if they had one.
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  const double most = std::min(relative_error_, kFarthest) / options_.target_error;
  if (all > 0)
    for (double& share : shares) share *= most / all;
  double stays = LargestToStay(shares);
  const double rows = static_cast<double>(radiosity_->memory());
  // The most that there is memory for.
  Splits splits = SplitsAbove(shares, stays);
  for (; splits.any && splits.growth * splits.growth * rows > static_cast<double>(kMostMemory); stays *= kFewer)
    splits = SplitsAbove(shares, kFewer * stays);
  if (!splits.any) {
    state_ = State::kExhausted;
    return;
  }
  PanelMesh panels = SplitMesh(world_, mesh.panels(), splits.places);
  std::vector<CellMesh::Borders> borders;
  for (const Panel& panel : panels.panels()) {
    const PanelMesh::Range range = mesh.panels().On(panel.element, panel.side);
    std::size_t i = range.first;
    while (i + 1 < range.last && mesh.panels().panels()[i].high <= panel.At(0)) ++i;
    borders.push_back(splits.borders[i]);
  }
  CellMesh finer(world_, std::move(panels), borders);
  std::vector<std::vector<double>> start = radiosity_->OnNodesOf(finer);
  StartMesh(std::move(finer), std::move(start));
}

GlossySolver::Splits GlossySolver::SplitsAbove(const std::vector<double>& shares, double stays) const {
  const CellMesh& mesh = radiosity_->mesh();
  const auto times = [&](double share) {
    int count = share > stays ? 1 : 0;
    while (stays > 0 && count < kMostTimes && count > 0 && share > kPerSplit * stays) share /= kPerSplit, ++count;
    return count;
  };
  Splits splits;
  splits.places.resize(mesh.panels().size());
  for (std::size_t i = 0; i < mesh.panels().size(); ++i) {
    const PanelMesh::Range range = mesh.CellsOf(i);
    splits.borders.push_back(mesh.BordersOf(i));
    CellMesh::Borders& borders = splits.borders.back();
    int in_places = 0;
    for (std::size_t j = range.first; j < range.last; ++j) {
      const DirectionCell& cell = mesh.cells()[j];
      const GlossyRadiosity::Off& off = radiosity_->OffAt(j);
      const double most = std::max(off.between_places, off.between_directions);
      if (cell.directions == 1 || most == 0) {
        in_places = std::max(in_places, times(shares[j]));
        continue;
      }
      in_places = std::max(in_places, times(shares[j] * off.between_places / most));
      const int parts = 1 << times(shares[j] * off.between_directions / most);
      for (int k = 1; k < parts; ++k) borders.push_back(cell.At(2.0 * k / parts - 1));
      splits.any |= parts > 1;
    }
    std::sort(borders.begin(), borders.end());
    SplitTimes(mesh.panels().panels()[i], in_places, splits.places[i]);
    splits.any |= !splits.places[i].empty();
    splits.growth += static_cast<double>(splits.places[i].size() + 1) * static_cast<double>(borders.size() + 1) /
                     static_cast<double>(range.last - range.first) / static_cast<double>(mesh.panels().size());
  }
  return splits;
}

}  // namespace flatlight
