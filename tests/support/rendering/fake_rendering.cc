// SPDX-License-Identifier: Apache-2.0
#include "tests/support/rendering/fake_rendering.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

namespace flatlight::testing {

class FakeRenderings::Fake final : public Rendering {
 public:
  Fake(FakeRenderings& owner, std::shared_ptr<const Scene> scene) : owner_(owner), scene_(std::move(scene)) {}

  void Advance(Executor& executor, const Cancellation& cancellation, const Clock&, Clock::Duration) override {
    if (!owner_.TakeStep(scene_->name(), cancellation)) return;
    if (owner_.on_step_) owner_.on_step_(scene_->name(), steps_, executor, cancellation);
    if (!cancellation.cancelled()) ++steps_;
  }
  bool done() const override { return steps_ >= owner_.total_; }
  EndReason end_reason() const override { return EndReason::kSamplesDone; }
  RenderProgress Progress() const override {
    RenderProgress progress;
    progress.fraction = static_cast<double>(steps_) / owner_.total_;
    progress.samples = 16.0 * steps_;
    progress.rays = 100.0 * steps_;
    progress.records = steps_ * owner_.records_per_step_;
    return progress;
  }
  std::shared_ptr<const Field> Snapshot() const override {
    auto field = std::make_shared<Field>();
    for (std::size_t i = 0; i < scene_->probes().size(); ++i) {
      const double value = i == 0 ? steps_ : std::min(steps_, 1);
      ProbeField probe;
      probe.irradiance.assign(scene_->probes()[i].receivers.size() * static_cast<std::size_t>(scene_->channels()),
                              value);
      probe.standard_error = probe.irradiance;
      probe.samples.assign(scene_->probes()[i].receivers.size(), 16 * value);
      field->probes.push_back(std::move(probe));
    }
    field->rays = 100.0 * steps_;
    for (int i = 0; i < steps_ * owner_.records_per_step_; ++i) {
      RecordField& record = field->records.emplace_back();
      record.curve = "floor";
      record.irradiance.assign(static_cast<std::size_t>(scene_->channels()), i);
      record.wave = static_cast<std::uint32_t>(i / owner_.records_per_step_);
      record.left_radius = record.right_radius = std::ldexp(1, -steps_);
    }
    return field;
  }

 private:
  FakeRenderings& owner_;
  const std::shared_ptr<const Scene> scene_;
  int steps_ = 0;
};

std::unique_ptr<Rendering> FakeRenderings::Start(std::shared_ptr<const Scene> scene, const Plan&) {
  return std::make_unique<Fake>(*this, std::move(scene));
}

void FakeRenderings::Hold() {
  const std::lock_guard lock(mutex_);
  held_ = true;
}

void FakeRenderings::Allow(int steps) {
  const std::lock_guard lock(mutex_);
  allowed_ += steps;
  changed_.notify_all();
}

void FakeRenderings::AllowUntil(const std::atomic<bool>& ended) {
  while (!ended) {
    Allow(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void FakeRenderings::Release() {
  const std::lock_guard lock(mutex_);
  held_ = false;
  changed_.notify_all();
}

std::vector<std::string> FakeRenderings::slices() const {
  const std::lock_guard lock(mutex_);
  return slices_;
}

bool FakeRenderings::TakeStep(const std::string& scene, const Cancellation& cancellation) {
  std::unique_lock lock(mutex_);
  // A cancellation tells nobody: it has to be asked for.
  while (held_ && allowed_ == 0 && !cancellation.cancelled()) changed_.wait_for(lock, std::chrono::milliseconds(1));
  if (cancellation.cancelled()) return false;
  if (held_) --allowed_;
  slices_.push_back(scene);
  return true;
}

}  // namespace flatlight::testing
