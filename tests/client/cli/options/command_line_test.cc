// SPDX-License-Identifier: Apache-2.0
#include "client/cli/options/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace flatlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

absl::StatusOr<CommandLine> Parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "flatlight");
  return ParseCommandLine(static_cast<int>(arguments.size()), arguments.data(), "1.2.3");
}

std::string ErrorOf(const std::vector<const char*>& arguments) {
  const auto line = Parse(arguments);
  return line.ok() ? "" : std::string(line.status().message().data(), line.status().message().size());
}

TEST(CommandLine, AllOfBench) {
  const auto line = Parse({"bench",
                           "a.json",
                           "gallery:ring",
                           "--gallery",
                           "--methods",
                           "path-tracing,exact",
                           "--budgets",
                           "256,16",
                           "--seeds",
                           "4",
                           "--repeats",
                           "2",
                           "--time-limit",
                           "7.5",
                           "--truth",
                           "t.json",
                           "-o",
                           "b.csv",
                           "-o",
                           "b.svg",
                           "--force",
                           "--max-bounces",
                           "0",
                           "--seed",
                           "9",
                           "--threads",
                           "1"});
  ASSERT_TRUE(line.ok()) << line.status();
  EXPECT_EQ(line->command, "bench");
  EXPECT_THAT(line->bench.scenes, ElementsAre("a.json", "gallery:ring"));
  EXPECT_THAT(line->bench.methods, ElementsAre("path-tracing", "exact"));
  EXPECT_THAT(line->bench.budgets, ElementsAre(16, 256));
  EXPECT_EQ(line->bench.seeds, 4U);
  EXPECT_EQ(line->bench.repeats, 2U);
  EXPECT_EQ(line->bench.time_limit, 7.5);
  EXPECT_FALSE(line->settings.has_time_limit());  // Of all runs together, not of each.
  EXPECT_THAT(line->bench.truths, ElementsAre("t.json"));
  EXPECT_THAT(line->outputs, ElementsAre("b.csv", "b.svg"));
  EXPECT_TRUE(line->bench.gallery && line->bench.force);
  EXPECT_EQ(line->settings.seed(), 9U);
  const auto compare = Parse({"bench", "compare", "a.csv", "b.csv", "--least", "0.1"});
  ASSERT_TRUE(compare.ok()) << compare.status();
  EXPECT_EQ(compare->command, "bench compare");
  EXPECT_THAT(compare->results, ElementsAre("a.csv", "b.csv"));
  EXPECT_EQ(compare->bench.least, 0.1);
  EXPECT_THAT(ErrorOf({"bench", "compare", "a.csv"}), HasSubstr("bench"));
  EXPECT_THAT(ErrorOf({"bench", "s", "--truth", "t.json", "--truth-samples", "5"}), HasSubstr("--truth-samples: "));
}

TEST(CommandLine, AllOfRender) {
  const auto line = Parse({"render",
                           "-",
                           "--method",
                           "path-tracing",
                           "--samples",
                           "64",
                           "--max-bounces",
                           "0",
                           "--seed",
                           "7",
                           "--derivatives",
                           "none",
                           "--target-error",
                           "0.01",
                           "--time-limit",
                           "1e3",
                           "--threads",
                           "2",
                           "--no-skip",
                           "colour",
                           "--no-skip",
                           "visibility",
                           "-o",
                           "a.json",
                           "-o",
                           "-",
                           "--json",
                           "-q",
                           "--server",
                           "host:1"});
  ASSERT_TRUE(line.ok()) << line.status();
  EXPECT_EQ(line->command, "render");
  EXPECT_EQ(line->scene, "-");
  EXPECT_THAT(line->outputs, ElementsAre("a.json", "-"));
  EXPECT_TRUE(line->json && line->quiet);
  EXPECT_EQ(line->server, "host:1");
  const v1::Settings& settings = line->settings;
  EXPECT_EQ(settings.method(), v1::Settings::PATH_TRACING);
  EXPECT_EQ(settings.samples(), 64U);
  EXPECT_TRUE(settings.has_max_bounces());
  EXPECT_EQ(settings.max_bounces(), 0U);
  EXPECT_EQ(settings.seed(), 7U);
  EXPECT_EQ(settings.derivatives(), v1::Settings::NONE);
  EXPECT_EQ(Parse({"render", "a", "--formulation", "arc-length"})->settings.formulation(), v1::Settings::ARC_LENGTH);
  const v1::Settings caching = Parse({"render", "a", "--error-control", "split-sphere", "--gather", "from-ray-tracing",
                                      "--extrapolation", "0", "--tolerance", "0.5", "--max-records", "3"})
                                   ->settings;
  EXPECT_EQ(caching.error_control(), v1::Settings::SPLIT_SPHERE);
  EXPECT_EQ(caching.gather(), v1::Settings::FROM_RAY_TRACING);
  EXPECT_TRUE(caching.has_extrapolation());
  EXPECT_EQ(caching.tolerance(), 0.5);
  EXPECT_EQ(caching.max_records(), 3u);
  const v1::Settings photons = Parse({"render", "a", "--photons", "100", "--final-gather", "false", "--bandwidth",
                                      "0.5", "--neighbours", "9", "--kernel", "triangle"})
                                   ->settings;
  EXPECT_EQ(photons.photons(), 100u);
  EXPECT_TRUE(photons.has_final_gather() && !photons.final_gather());
  EXPECT_EQ(photons.bandwidth(), 0.5);
  EXPECT_EQ(photons.neighbours(), 9u);
  EXPECT_EQ(photons.kernel(), v1::Settings::TRIANGLE);
  EXPECT_EQ(settings.target_error(), 0.01);
  EXPECT_EQ(settings.time_limit(), 1000);
  EXPECT_EQ(settings.threads(), 2U);
  EXPECT_THAT(settings.no_skip(), ElementsAre("colour", "visibility"));
}

TEST(CommandLine, PicturesTakeThePlaceOfProbes) {
  const auto line = Parse({"render", "a", "--picture", "800x600"});
  ASSERT_TRUE(line.ok()) << line.status();
  ASSERT_EQ(line->probes.size(), 1U);
  EXPECT_EQ(line->probes[0].fluence().width(), 800U);
  EXPECT_EQ(line->probes[0].fluence().height(), 600U);
  EXPECT_FALSE(line->probes[0].fluence().has_min());
  EXPECT_THAT(Parse({"render", "a"})->probes, ::testing::IsEmpty());
  for (const char* bad : {"", "x", "800", "800x", "x600", "0x5", "5x0", "8*6", "-8x6", "8x6x7", "8.5x6"}) {
    EXPECT_THAT(ErrorOf({"render", "a", "--picture", bad}), HasSubstr("--picture")) << bad;
  }
}

TEST(CommandLine, NothingIsSetThatWasNotAskedFor) {
  const auto line = Parse({"submit", "scene.json"});
  ASSERT_TRUE(line.ok());
  EXPECT_EQ(line->settings.ByteSizeLong(), 0U);
  EXPECT_FALSE(line->tolerance);
}

TEST(CommandLine, OptionsTakeOneValueEach) {
  const auto line = Parse({"render", "-o", "a.json", "scene.json", "--no-skip", "colour"});
  ASSERT_TRUE(line.ok()) << line.status();
  EXPECT_EQ(line->scene, "scene.json");
}

TEST(CommandLine, TheServerMayComeFirst) {
  const auto line = Parse({"--server", "unix:/x", "jobs"});
  ASSERT_TRUE(line.ok()) << line.status();
  EXPECT_EQ(line->server, "unix:/x");
}

TEST(CommandLine, HelpAndVersionAreTexts) {
  EXPECT_EQ(Parse({"--version"})->text, "flatlight 1.2.3\n");
  EXPECT_THAT(Parse({"--help"})->text, HasSubstr("130 interrupted"));
  EXPECT_EQ(Parse({"--help"})->command, "");
  for (const char* command :
       {"render", "submit", "watch", "jobs", "show", "fetch", "cancel", "scenes", "explain", "validate", "compare"}) {
    EXPECT_THAT(Parse({command, "--help"})->text, HasSubstr(command));
    EXPECT_THAT(Parse({"--help"})->text, HasSubstr(command));
  }
}

TEST(CommandLine, MistakesAreNamed) {
  EXPECT_THAT(ErrorOf({}), HasSubstr("command"));
  EXPECT_THAT(ErrorOf({"bogus", "x"}), HasSubstr("'bogus' is not a command"));
  EXPECT_THAT(ErrorOf({"render"}), HasSubstr("SCENE is required; see flatlight render --help"));
  EXPECT_THAT(ErrorOf({"render", "a", "b"}), HasSubstr("b"));
  EXPECT_THAT(ErrorOf({"render", "a", "--foo", "3"}), HasSubstr("--foo"));
  EXPECT_THAT(ErrorOf({"compare", "a"}), HasSubstr("RESULTS"));
  EXPECT_THAT(ErrorOf({"jobs", "--server", ""}), HasSubstr("--server"));
  EXPECT_EQ(ErrorOf({"compare", "a", "b", "--tolerance", "-1"}), "--tolerance: '-1'; must be a number from 0");
  EXPECT_EQ(ErrorOf({"render", "a", "--method", "magic"}),
            "--method: 'magic'; must be one of exact, path-tracing, ray-tracing, reference, irradiance-caching, "
            "photon-mapping");
  EXPECT_EQ(ErrorOf({"render", "a", "--samples", "0", "--threads", "x"}),
            "--samples: '0'; must be a whole number from 1 to 4294967295\n"
            "--threads: 'x'; must be a whole number from 1 to 4294967295");
  EXPECT_EQ(ErrorOf({"render", "a", "--photons", "0", "--final-gather", "perhaps", "--neighbours", "1"}),
            "--photons: '0'; must be a whole number from 1 to 4294967295\n"
            "--final-gather: 'perhaps'; must be true or false\n"
            "--neighbours: '1'; must be a whole number from 2 to 4294967295");
  EXPECT_EQ(ErrorOf({"render", "a", "--target-error", "1.5"}),
            "--target-error: '1.5'; must be a number above 0, at most 1");
  for (const char* bad : {"", "nan", "inf", "-1", "0", "1x", "1e999"})
    EXPECT_THAT(ErrorOf({"render", "a", "--time-limit", bad}), HasSubstr("--time-limit: '")) << bad;
}

}  // namespace
}  // namespace flatlight
