// SPDX-License-Identifier: Apache-2.0
#include "core/render/irradiance_caching_rendering.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/cache/interpolation.h"
#include "core/plane/reference/panel_mesh.h"
#include "core/render/light_paths.h"
#include "core/render/record_exchange.h"
#include "core/render/skips.h"
#include "core/render/state_stream.h"
#include "core/render/world_units.h"
#include "core/sampling/hash.h"

namespace flatlight {
namespace {

// Between two looks at the clock.
constexpr std::size_t kRecordsPerThread = 4;
// What panels may be off by, as a share of the tolerance, at so many points of each probe.
constexpr double kPanelError = 0.02;
// Of the solver's error, that of irradiance from its panels without what their residuals give, which is in its values:
// half of that is in its error, too.
constexpr double kWithoutResiduals = 3;
// What records of an earlier job may be off by, as a share of the tolerance: that job's may have been larger.
constexpr double kKnownNoise = 0.5;
constexpr std::size_t kPointsOfPanels = 32;
constexpr std::size_t kStretch = 32;  // Of points that are searched for events.

}  // namespace

IrradianceCachingRendering::IrradianceCachingRendering(std::shared_ptr<const Scene> scene,
                                                       std::shared_ptr<const RayCaster> caster, const Plan& plan)
    : scene_(std::move(scene)), caster_(std::move(caster)), max_threads_(plan.MaxThreads()) {
  const Settings& settings = plan.settings;
  placement_options_.control = *settings.error_control;
  placement_options_.degree = *settings.extrapolation;
  placement_options_.clamp_neighbours = settings.neighbour_clamping.value_or(false);
  placement_options_.overture = settings.overture.value_or(false);
  if (settings.tolerance) placement_options_.tolerance = *settings.tolerance;
  if (plan.Takes(skip::kEmission)) {
    done_ = true;
    return;
  }
  maker_options_.control = *settings.error_control;
  maker_options_.key = ChildKey(0, settings.seed.value_or(0));
  if (!DirectLightOnly(*scene_, settings) && !plan.Takes(skip::kBounces)) {
    if (settings.gather == Gather::kReference) {
      ReferenceOptions options;
      options.derivatives = 0;
      options.channels = scene_->channels() == 1 ? 1 : kMaxChannels;
      options.max_bounces = settings.max_bounces;
      options.target_error = settings.tolerance ? std::clamp(kPanelError * *settings.tolerance, 1e-6, 1e-3) : 1e-5;
      options.most_points = kPointsOfPanels;
      panels_.emplace(scene_, caster_, options);
    } else {
      maker_options_.rays = *settings.samples;
      RayTreeOptions options;
      options.max_bounces = settings.max_bounces;
      options.end_black_paths = plan.Takes(skip::kBlackPaths);
      tree_.emplace(caster_, options);
      if (settings.gather == Gather::kPhotonMap) photons_.emplace(scene_, caster_, settings);
    }
  }
  charts_ = ChartsOf(caster_->scene());
  tracks_ = TracksOf(*scene_, *caster_);
  // One on each track is the least there can be.
  if (settings.max_records) {
    placement_options_.most_records = std::max(std::size_t{*settings.max_records}, tracks_.tracks.size());
  }
  known_records_ = plan.known_records;
  if (photons_) return;
  if (!panels_) {
    Prepare();
  } else if (known_records_ && maker_options_.control != ErrorControl::kVisibilityEvents) {
    // What is known already may be enough, without panels.
    Prepare();
    BeginWaves();
    if (!done_) placement_.reset(), records_.clear(), begun_ = false;
  }
}

bool IrradianceCachingRendering::IsGoodEnough(const CacheRecord& record) const {
  const bool by_distance = maker_options_.control == ErrorControl::kSplitSphere ||
                           maker_options_.control == ErrorControl::kBoundedSplitSphere;
  if (record.known <= placement_options_.degree || (by_distance && !record.surroundings.inverse_distance)) return false;
  // What rays bring is as good as their number, which is the same.
  return !panels_ || placement_options_.most_records ||
         record.noise <= kKnownNoise * placement_options_.tolerance * record.Irradiance();
}

void IrradianceCachingRendering::BeginWaves() {
  if (known_records_) {
    for (const RecordField& known : *known_records_) {
      std::optional<CacheRecord> record = FromWorld(known, tracks_, *scene_);
      if (!record || !IsGoodEnough(*record)) continue;
      record->events = events_[record->track];
      waves_ = std::max(waves_, record->wave + 1);
      records_.push_back(*record);
    }
  }
  reused_ = records_.size();
  placement_->SetEvents({events_.begin(), events_.end()});
  wave_ = placement_->Next(records_);
  done_ = wave_.empty();
  begun_ = true;
  resumed_.clear();
}

void IrradianceCachingRendering::Prepare() {
  placement_.emplace(tracks_.points, placement_options_);
  stretches_.clear();
  if (panels_ || tree_) placement_->SetCorners(tracks_.corners);
  events_.resize(tracks_.tracks.size());
  for (std::size_t t = 0; t < tracks_.points.size() && maker_options_.control == ErrorControl::kVisibilityEvents; ++t) {
    for (std::size_t first = 0; first + 1 < tracks_.points[t].size(); first += kStretch)
      stretches_.emplace_back(static_cast<std::uint32_t>(t), first);
  }
  if (begun_) placement_->SetEvents({events_.begin(), events_.end()});
}

EndReason IrradianceCachingRendering::end_reason() const {
  return placement_options_.most_records ? EndReason::kSamplesDone : EndReason::kConverged;
}

std::unique_ptr<RecordMaker> IrradianceCachingRendering::TakeMaker() {
  return makers_.Take(
      [&] { return std::make_unique<RecordMaker>(*caster_, charts_, tree_ ? &*tree_ : nullptr, maker_options_); });
}

void IrradianceCachingRendering::Advance(Executor& executor, const Cancellation& cancellation, const Clock& clock,
                                         Clock::Duration budget) {
  const Clock::Time start = clock.Now();
  const int threads = std::max(std::min(max_threads_, executor.threads()), 1);
  has_advanced_ = true;
  while (!done_ && !cancellation.cancelled()) {
    if (panels_ && panels_->state() == ReferenceSolver::State::kWorks) {
      panels_->Advance(executor, threads, cancellation, clock, budget - (clock.Now() - start));
      if (panels_->state() == ReferenceSolver::State::kWorks) return;
      maker_options_.reflected = ReflectedLight{&panels_->mesh(), &panels_->light()};
      maker_options_.reflected_error = kWithoutResiduals * panels_->relative_error();
      Prepare();
    } else if (photons_ && !photons_->done()) {
      photons_->Advance(executor, threads, cancellation, clock, budget - (clock.Now() - start));
      if (!photons_->done()) return;
      if (resumed_.empty()) rays_ += photons_->rays();
      doubt_.emplace(photons_->DoubtOf(*tree_));
      tree_.emplace(photons_->EndOf(*tree_));
      maker_options_.doubt = &*doubt_;
      Prepare();
    } else if (searched_ < stretches_.size()) {
      FindEvents(executor, threads, cancellation);
    } else if (!begun_) {
      BeginWaves();
    } else {
      MakeRecords(executor, threads, cancellation);
    }
    if (clock.Now() - start >= budget) return;
  }
}

void IrradianceCachingRendering::FindEvents(Executor& executor, int threads, const Cancellation& cancellation) {
  const std::size_t count = std::min(stretches_.size() - searched_, static_cast<std::size_t>(threads));
  std::vector<std::vector<VisibilityEvent>> found(count);
  executor.ParallelFor(count, threads, [&](std::size_t i) {
    const auto [track, first] = stretches_[searched_ + i];
    const std::vector<double>& points = tracks_.points[track];
    const std::size_t last = std::min(first + kStretch + 1, points.size());
    std::unique_ptr<RecordMaker> maker = TakeMaker();
    found[i] = EventsBetween(maker->skyline(), tracks_.tracks[track], std::span(points).subspan(first, last - first),
                             cancellation);
    makers_.Return(std::move(maker));
  });
  if (cancellation.cancelled()) return;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<VisibilityEvent>& events = events_[stretches_[searched_ + i].first];
    events.insert(events.end(), found[i].begin(), found[i].end());
  }
  searched_ += count;
  resumed_.clear();
}

void IrradianceCachingRendering::MakeRecords(Executor& executor, int threads, const Cancellation& cancellation) {
  const std::size_t count =
      std::min(wave_.size() - made_.size(), kRecordsPerThread * static_cast<std::size_t>(threads));
  std::vector<CacheRecord> records(count);
  std::vector<double> cast(count, 0.0);
  executor.ParallelFor(count, threads, [&](std::size_t i) {
    if (cancellation.cancelled()) return;
    const RecordPlace& place = wave_[made_.size() + i];
    std::unique_ptr<RecordMaker> maker = TakeMaker();
    records[i] = maker->Make(tracks_.tracks[place.track], place.track, place.at, waves_, cancellation, cast[i]);
    makers_.Return(std::move(maker));
    records[i].events = events_[place.track];
  });
  // Some may have been left half made.
  if (cancellation.cancelled()) return;
  for (std::size_t i = 0; i < count; ++i) rays_ += cast[i], made_.push_back(records[i]);
  resumed_.clear();
  if (made_.size() < wave_.size()) return;
  records_.insert(records_.end(), made_.begin(), made_.end());
  made_.clear();
  ++waves_;
  wave_ = placement_->Next(records_);
  done_ = wave_.empty();
}

template <class Self, class Stream>
void IrradianceCachingRendering::State(Self& self, Stream& stream) {
  stream.Filled(self.events_);
  stream(self.searched_, self.records_, self.wave_, self.made_, self.waves_, self.reused_, self.rays_, self.begun_);
  stream.Require(self.reused_ <= self.records_.size() && self.made_.size() <= self.wave_.size());
  const std::size_t tracks = self.tracks_.tracks.size();
  for (const auto* records : {&self.records_, &self.made_})
    for (const CacheRecord& record : *records) stream.Require(record.track < tracks);
  for (const RecordPlace& place : self.wave_) stream.Require(place.track < tracks);
}

std::string IrradianceCachingRendering::Checkpoint(std::size_t most_bytes) const {
  if (!resumed_.empty()) return has_advanced_ || resumed_.size() > most_bytes ? std::string() : resumed_;
  if (!placement_ || done_) return {};
  StateWriter writer(most_bytes);
  State(*this, writer);
  return writer.Take();
}

bool IrradianceCachingRendering::Resume(std::string_view checkpoint) {
  if (done_) return false;
  events_.resize(tracks_.tracks.size());
  StateReader reader(checkpoint);
  State(*this, reader);
  if (!reader.AtEnd()) return false;
  for (auto* records : {&records_, &made_})
    for (CacheRecord& record : *records) record.events = events_[record.track];
  resumed_ = checkpoint;
  // Else when it is known what records gather from.
  if (placement_) Prepare();
  return true;
}

RenderProgress IrradianceCachingRendering::Progress() const {
  RenderProgress progress;
  progress.rays = rays_;
  progress.records = static_cast<double>(records_.size());
  progress.samples = records_.empty() ? 0 : maker_options_.rays;
  if (done_) {
    progress.fraction = 1;
  } else if (placement_options_.most_records) {
    progress.fraction =
        static_cast<double>(records_.size() + made_.size()) / static_cast<double>(*placement_options_.most_records);
    progress.fraction = std::min(progress.fraction, 0.99);
  }
  return progress;
}

std::shared_ptr<const Field> IrradianceCachingRendering::Snapshot() const {
  auto field = std::make_shared<Field>();
  field->rays = rays_;
  if (photons_) field->photons = static_cast<double>(photons_->traced());
  field->probes.resize(scene_->probes().size());
  // Nothing is known yet.
  if (caster_ && !tracks_.tracks.empty() && (records_.empty() || !placement_)) return field;
  const WorldUnits units(scene_->frame());
  const auto channels = static_cast<std::size_t>(scene_->channels());
  std::vector<CacheRecord> records = records_;
  std::vector<TrackInterpolation> interpolations;
  if (placement_) {
    placement_->SetFootprints(records);
    std::vector<std::vector<const CacheRecord*>> of_track(tracks_.tracks.size());
    for (const CacheRecord& record : records) of_track[record.track].push_back(&record);
    for (auto& track : of_track) {
      interpolations.emplace_back(std::move(track), placement_options_.degree, WeightingOf(placement_options_.control));
    }
  }
  std::size_t point = 0;
  for (std::size_t p = 0; p < scene_->probes().size(); ++p) {
    ProbeField& values = field->probes[p];
    for (std::size_t i = 0; i < scene_->probes()[p].receivers.size(); ++i, ++point) {
      Interpolated value;
      if (placement_) {
        const TrackPlace& place = tracks_.of_point[point];
        value = interpolations[place.track].At(place.at);
      }
      for (std::size_t c = 0; c < channels; ++c) {
        values.irradiance.push_back(units.irradiance * value.irradiance.value[c]);
        values.estimated_error.push_back(units.irradiance * value.error);
      }
    }
  }
  for (const CacheRecord& record : records)
    field->records.push_back(ToWorld(record, tracks_.tracks[record.track], *scene_));
  field->reused_records = reused_;
  return field;
}

}  // namespace flatlight
