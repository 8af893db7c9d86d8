// SPDX-License-Identifier: Apache-2.0
// Irradiance caching whose records gather from a photon map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tests/core/render/caching_support.h"
#include "tests/support/transport/mistakes.h"
#include "tests/support/transport/render.h"
#include "tests/support/transport/scene_maker.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

// Rays that end in a photon map, which is biased and noisy, and says so.
TEST(CachingFromPhotonsTest, PhotonsTellWhatPanelsTell) {
  const auto scene = DividedRoom().Build();
  for (const std::optional<std::uint32_t> bounces : {std::optional<std::uint32_t>(1), std::optional<std::uint32_t>()}) {
    Settings settings = Caching();
    settings.max_bounces = bounces;
    settings.gather = Gather::kPhotonMap;
    settings.tolerance = 0.03;
    const auto expected = ReferenceOf(scene, bounces);
    std::shared_ptr<const Field> field;
    double before = 1;
    for (const std::uint32_t photons : {1u << 13, 1u << 18}) {
      settings.photons = photons;
      field = Render(scene, settings).field;
      const Difference difference = DifferenceOf(*field, *expected);
      EXPECT_LT(difference.rms, before / 3);
      before = difference.rms;
    }
    EXPECT_LT(before, 0.6 * *settings.tolerance);
    EXPECT_EQ(field->photons, static_cast<double>(*settings.photons));
    EXPECT_LT(ShareAboveEstimate(*field, *expected, 2), 0.05);
    settings.seed = 1;
    EXPECT_NE(HashOf(*Render(scene, settings).field), HashOf(*field));
  }
}

// Mirrors and glass, which panels cannot tell.
TEST(CachingFromPhotonsTest, PhotonsTellAboutAllMaterials) {
  const auto scene = RoomOfAllMaterials().Build();
  Settings settings = Caching();
  settings.gather = Gather::kPhotonMap;
  settings.tolerance = 0.05;
  const auto field = Render(scene, settings).field;
  const auto expected = Render(scene, Sampled(512)).field;
  double squares = 0, sum = 0;
  for (std::size_t p = 0; p < field->probes.size(); ++p) {
    for (std::size_t i = 0; i < field->probes[p].irradiance.size(); ++i) {
      const double truth = expected->probes[p].irradiance[i], off = field->probes[p].irradiance[i] - truth;
      squares += off * off, sum += truth * truth;
    }
  }
  EXPECT_LT(std::sqrt(squares / sum), 0.1);
}

TEST(CachingFromPhotonsTest, SettingsOfAPhotonMapThatMakeNoSenseAreMistakes) {
  Settings settings = Caching();
  settings.photons = 100;
  EXPECT_THAT(Mistakes(*DividedRoom().Build(), settings),
              UnorderedElementsAre(HasSubstr("settings.photons: applies to irradiance-caching where it gathers")));
  settings.gather = Gather::kPhotonMap;
  EXPECT_THAT(Mistakes(*DividedRoom().Build(), settings), testing::IsEmpty());
  for (const std::uint32_t photons : {0u, 1u << 30}) {
    settings.photons = photons;
    EXPECT_THAT(Mistakes(*DividedRoom().Build(), settings),
                UnorderedElementsAre(HasSubstr("settings.photons: is " + std::to_string(photons))));
  }
  settings.photons.reset();
  settings.max_bounces = 0;
  EXPECT_THAT(Mistakes(*DividedRoom().Build(), settings),
              UnorderedElementsAre(HasSubstr("settings.gather: is from-photon-map, but nothing is reflected")));
}

}  // namespace
}  // namespace flatlight
