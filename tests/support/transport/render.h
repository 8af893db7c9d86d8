// SPDX-License-Identifier: Apache-2.0
// Whole renderings in one call.
#ifndef FLATLIGHT_TESTS_SUPPORT_TRANSPORT_RENDER_H_
#define FLATLIGHT_TESTS_SUPPORT_TRANSPORT_RENDER_H_

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "core/execution/thread_pool.h"
#include "core/render/plan.h"
#include "core/render/rendering.h"

namespace flatlight {

inline constexpr Clock::Duration kForever = Clock::Duration::max();

// The plan; stops the program if the settings have mistakes.
inline Plan PlanFor(const Scene& scene, const Settings& settings) {
  Diagnostics diagnostics;
  std::optional<Plan> plan = MakePlan(scene, settings, diagnostics);
  for (const Diagnostic& diagnostic : diagnostics.kept()) {
    std::fprintf(stderr, "test settings: %s: %s\n", diagnostic.path.c_str(), diagnostic.message.c_str());
  }
  if (!plan.has_value()) std::abort();
  return *plan;
}

// A rendering that came to its end.
struct Ended {
  std::shared_ptr<const Field> field;
  EndReason reason = EndReason::kConverged;
};

inline Ended Render(const std::shared_ptr<const Scene>& scene, const Settings& settings, Executor& executor,
                    Clock::Duration budget = kForever) {
  const std::unique_ptr<Rendering> rendering = StartRendering(scene, PlanFor(*scene, settings));
  const SteadyClock clock;
  const Cancellation never;
  while (!rendering->done()) rendering->Advance(executor, never, clock, budget);
  return {rendering->Snapshot(), rendering->end_reason()};
}

inline Ended Render(const std::shared_ptr<const Scene>& scene, const Settings& settings, int threads = 1,
                    Clock::Duration budget = kForever) {
  ThreadPool pool(threads);
  return Render(scene, settings, pool, budget);
}

// FNV-1a over the bits of all values.
inline std::uint64_t HashOf(const Field& field) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const ProbeField& probe : field.probes) {
    for (const std::vector<double>* values :
         {&probe.irradiance, &probe.standard_error, &probe.gradient, &probe.hessian, &probe.gradient_error,
          &probe.hessian_error, &probe.samples, &probe.irradiance_error, &probe.rotation_gradient,
          &probe.rotation_gradient_error, &probe.estimated_error, &probe.estimated_bias}) {
      for (const double value : *values) {
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof(bits));
        hash = (hash ^ bits) * 0x100000001b3u;
      }
    }
  }
  return hash;
}

inline Settings Sampled(std::uint32_t samples, std::uint32_t seed = 0) {
  Settings settings;
  settings.method = Method::kPathTracing;
  settings.samples = samples;
  settings.seed = seed;
  return settings;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_SUPPORT_TRANSPORT_RENDER_H_
