// SPDX-License-Identifier: Apache-2.0
// What will be done, decided before any ray is cast, and why.
#ifndef FLATLIGHT_CORE_RENDER_PLAN_H_
#define FLATLIGHT_CORE_RENDER_PLAN_H_

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/render/field.h"
#include "core/render/settings.h"
#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"

namespace flatlight {

enum class SkipDecision : std::uint8_t { kTaken, kNotApplicable, kDisabled };

struct SkipEntry {
  std::string name;
  SkipDecision decision = SkipDecision::kNotApplicable;
  std::string reason;
};

struct PlanPass {
  std::string name;
  double points = 0;
  double samples = 0;        // Paths a point; 0 if deterministic or open-ended.
  double expected_rays = 0;  // 0 if none is needed.
};

struct Plan {
  // Settings as they apply: method, derivatives, seed and (for path tracing) samples are always there; samples is
  // absent if the end is left to target_error or time_limit.
  Settings settings;
  std::optional<double> picture_samples;  // Paths a pixel; absent if there is none, or if the end is left open.
  std::vector<SkipEntry> skips;
  std::vector<PlanPass> passes;
  // Exact light looks for what is seen in a triangulation of the plane, where there can be one; else in the tree.
  bool triangles = false;
  // Of an earlier job, for irradiance caching to begin with; null if there are none. Not MakePlan's to set.
  std::shared_ptr<const std::vector<RecordField>> known_records;
  std::string summary;

  bool Takes(const std::string& skip) const { return Decided(skip, SkipDecision::kTaken); }
  bool Disables(const std::string& skip) const { return Decided(skip, SkipDecision::kDisabled); }
  // Threads to use at most; executors have their own limit.
  int MaxThreads() const {
    constexpr std::uint32_t kMost = std::numeric_limits<int>::max();
    return static_cast<int>(std::min(settings.threads.value_or(kMost), kMost));
  }

 private:
  bool Decided(const std::string& skip, SkipDecision decision) const {
    for (const SkipEntry& entry : skips)
      if (entry.name == skip) return entry.decision == decision;
    return false;
  }
};

// All names that Settings::no_skip may hold.
const std::vector<std::string>& SkipNames();

// As in the settings: "exact", "path-tracing" and so on.
const std::vector<std::string>& MethodNames();

// Absent if the settings have mistakes or don't suit the scene; `diagnostics` then says which ("settings.samples").
std::optional<Plan> MakePlan(const Scene& scene, const Settings& settings, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_RENDER_PLAN_H_
