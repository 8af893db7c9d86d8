// SPDX-License-Identifier: Apache-2.0
// What tests of irradiance caching have in common.
#ifndef FLATLIGHT_TESTS_CORE_RENDER_CACHING_SUPPORT_H_
#define FLATLIGHT_TESTS_CORE_RENDER_CACHING_SUPPORT_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "core/render/field.h"
#include "core/render/settings.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {

inline Settings Caching() {
  Settings settings;
  settings.method = Method::kIrradianceCaching;
  return settings;
}

// The largest and the root mean square difference from the reference over all probes, relative to the irradiance or 1 %
// of its mean.
struct Difference {
  double largest = 0;
  double rms = 0;
};

inline std::shared_ptr<const Field> ReferenceOf(const std::shared_ptr<const Scene>& scene,
                                                std::optional<std::uint32_t> max_bounces = std::nullopt) {
  Settings truth;
  truth.method = Method::kReference;
  truth.derivatives = Derivatives::kNone;
  truth.max_bounces = max_bounces;
  return Render(scene, truth).field;
}

inline Difference DifferenceOf(const Field& field, const Field& truth) {
  Difference difference;
  double count = 0;
  for (std::size_t p = 0; p < field.probes.size(); ++p) {
    EXPECT_EQ(field.probes[p].irradiance.size(), truth.probes[p].irradiance.size());
    const std::vector<double>& truths = truth.probes[p].irradiance;
    const double mean = std::accumulate(truths.begin(), truths.end(), 0.0) / static_cast<double>(truths.size());
    for (std::size_t i = 0; i < truths.size(); ++i) {
      const double off = std::abs(field.probes[p].irradiance[i] - truths[i]) / std::max(truths[i], 0.01 * mean);
      difference.largest = std::max(difference.largest, off);
      difference.rms += off * off;
      ++count;
    }
  }
  difference.rms = std::sqrt(difference.rms / count);
  return difference;
}

inline Difference FromReference(const std::shared_ptr<const Scene>& scene, const Settings& settings) {
  return DifferenceOf(*Render(scene, settings).field, *ReferenceOf(scene, settings.max_bounces));
}

// Of the points: where the error is more than so many times its estimate.
inline double ShareAboveEstimate(const Field& field, const Field& truth, double times) {
  double above = 0, count = 0;
  for (std::size_t p = 0; p < field.probes.size(); ++p) {
    for (std::size_t i = 0; i < field.probes[p].irradiance.size(); ++i, ++count) {
      const double error = std::abs(field.probes[p].irradiance[i] - truth.probes[p].irradiance[i]);
      // What the reference is off by, 1e-6, aside.
      if (error > times * field.probes[p].estimated_error[i] + 1e-6 * truth.probes[p].irradiance[i]) ++above;
    }
  }
  return above / count;
}

// A room with a lamp, a blocker, a disc, and a wall that stands on the floor and lets light through above.
inline SceneMaker DividedRoom(std::uint32_t points = 60) {
  SceneMaker maker = SquareRoom({.reflectance = {0.6}}, points);
  maker.Segment("lamp", {-0.4, 0.9}, {-0.8, 0.85}, {.radiance = {5}});
  maker.Segment("divider", {0.1, -1}, {0.1, 0.4}, {.reflectance = {0.3}});
  maker.Segment("blocker", {-0.7, 0.1}, {-0.4, 0.15}, {.reflectance = {0.5}});
  maker.Arc("disc", {{0.5, 0.3}, 0.15, 0, -6.283185307179586}, {.reflectance = {0.7}});
  return maker;
}

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_CORE_RENDER_CACHING_SUPPORT_H_
