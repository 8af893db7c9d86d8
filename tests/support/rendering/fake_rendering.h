// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_TESTS_SUPPORT_RENDERING_FAKE_RENDERING_H_
#define FLATLIGHT_TESTS_SUPPORT_RENDERING_FAKE_RENDERING_H_

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/render/rendering.h"

namespace flatlight::testing {

// Renderings whose pace a test sets. Each slice takes one step; after `total` steps a rendering is done. Every value at
// step n is n, except that steps after the first leave the points of probes other than the first unchanged.
class FakeRenderings {
 public:
  // Called in each slice, with the scene's name and the number of steps done. May block; must return once
  // `cancellation` says so. What it throws is thrown by the slice.
  using OnStep = std::function<void(const std::string& scene, int steps, Executor&, const Cancellation& cancellation)>;

  explicit FakeRenderings(int total_steps) : total_(total_steps) {}
  // Records that each step adds to the log; every step halves all radii. Default: none.
  void set_records_per_step(int records) { records_per_step_ = records; }
  void set_on_step(OnStep on_step) { on_step_ = std::move(on_step); }

  void set_total_steps(int total_steps) { total_ = total_steps; }

  // For the scheduler.
  std::unique_ptr<Rendering> Start(std::shared_ptr<const Scene> scene, const Plan& plan);

  // While held, renderings may take only as many steps as have been allowed; a slice without one waits for it.
  void Hold();
  void Allow(int steps);
  void Release();
  // While held: allows one step after another until `ended`, so that slices that are under way come to their end.
  void AllowUntil(const std::atomic<bool>& ended);

  // Scenes by name, in the order of their slices.
  std::vector<std::string> slices() const;

 private:
  class Fake;
  // Returns whether a step may be taken; not if cancelled meanwhile.
  bool TakeStep(const std::string& scene, const Cancellation& cancellation);

  int total_;
  int records_per_step_ = 0;
  OnStep on_step_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool held_ = false;                // Guarded by mutex_.
  int allowed_ = 0;                  // Guarded by mutex_.
  std::vector<std::string> slices_;  // Guarded by mutex_.
};

}  // namespace flatlight::testing

#endif  // FLATLIGHT_TESTS_SUPPORT_RENDERING_FAKE_RENDERING_H_
