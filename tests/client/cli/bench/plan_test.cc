// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "client/cli/bench/plan/budgets.h"
#include "client/cli/bench/plan/truth_choice.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;

v1::GetCapabilitiesResponse Server(const std::vector<std::string>& methods) {
  v1::GetCapabilitiesResponse server;
  for (const std::string& method : methods) server.add_methods(method);
  return server;
}

const v1::GetCapabilitiesResponse kServer = Server({"exact", "path-tracing"});

TEST(TruthChoice, ExactWhereThereIsDirectLightOnly) {
  TruthQuestion black;
  EXPECT_EQ(ChooseTruth(black, kServer).name, "exact");
  EXPECT_FALSE(ChooseTruth(black, kServer).max_bounces);
  EXPECT_EQ(ChooseTruth(black, kServer).note, "");
  TruthQuestion direct;
  direct.max_reflectance = 0.5;
  direct.max_bounces = 0;
  const TruthChoice choice = ChooseTruth(direct, kServer);
  EXPECT_EQ(choice.render->method(), v1::Settings::EXACT);
  EXPECT_EQ(choice.max_bounces, 0U);
  EXPECT_EQ(choice.note, "");
}

TEST(TruthChoice, ASceneThatReflectsIsBenchedWithDirectLight) {
  TruthQuestion question;
  question.max_reflectance = 0.5;
  const TruthChoice choice = ChooseTruth(question, kServer);
  EXPECT_EQ(choice.name, "exact");
  EXPECT_EQ(choice.max_bounces, 0U);
  EXPECT_THAT(choice.note, HasSubstr("--truth"));
}

TEST(TruthChoice, ReferenceWhereItTakesTheScene) {
  const v1::GetCapabilitiesResponse server = Server({"exact", "path-tracing", "reference"});
  TruthQuestion question;
  question.max_reflectance = 0.5;
  EXPECT_EQ(ChooseTruth(question, server).render->method(), v1::Settings::REFERENCE);
  EXPECT_FALSE(ChooseTruth(question, server).max_bounces);
  question.max_bounces = 3;
  EXPECT_EQ(ChooseTruth(question, server).render->max_bounces(), 3U);
  EXPECT_EQ(ChooseTruth({}, server).name, "exact") << "nothing reflects";
  question.max_bounces.reset();
  question.reference = false;
  EXPECT_EQ(ChooseTruth(question, server).name, "exact");
  EXPECT_EQ(ChooseTruth(question, server).max_bounces, 0U);
}

TEST(TruthChoice, BouncesWithoutATruthAreRefused) {
  TruthQuestion question;
  question.max_reflectance = 0.5;
  question.max_bounces = 3;
  const TruthChoice choice = ChooseTruth(question, kServer);
  EXPECT_FALSE(choice.render || choice.file);
  EXPECT_THAT(choice.note, HasSubstr("3 bounces"));
  EXPECT_FALSE(ChooseTruth({}, Server({"path-tracing"})).render);
}

TEST(TruthChoice, ManySamples) {
  TruthQuestion question;
  question.max_reflectance = 0.5;
  question.samples = 100;
  const TruthChoice choice = ChooseTruth(question, kServer);
  EXPECT_EQ(choice.name, "path-tracing 100");
  EXPECT_EQ(choice.render->samples(), 100U);
  EXPECT_EQ(choice.render->seed(), kTruthSeed);
  EXPECT_FALSE(choice.max_bounces);
}

TEST(TruthChoice, AFileSaysHowManyBounces) {
  v1::RenderResult file;
  file.mutable_plan()->mutable_settings()->set_max_bounces(2);
  TruthQuestion question;
  question.max_reflectance = 0.5;
  question.file = &file;
  question.file_name = "file 01";
  EXPECT_EQ(ChooseTruth(question, kServer).max_bounces, 2U);
  EXPECT_EQ(ChooseTruth(question, kServer).name, "file 01");
  EXPECT_FALSE(ChooseTruth(question, kServer).render);
  question.max_bounces = 5;  // The user knows better.
  EXPECT_EQ(ChooseTruth(question, kServer).max_bounces, 5U);
}

TEST(Seeds, DifferFromRunToRunAndBudgetToBudget) {
  std::set<std::uint32_t> seeds;
  for (const std::uint32_t base : {0U, 1U})
    for (const std::uint32_t budget : DefaultBudgets())
      for (std::uint32_t number = 0; number < 100; ++number) seeds.insert(SeedOfRun(base, budget, number));
  EXPECT_EQ(seeds.size(), 2 * 100 * DefaultBudgets().size());
  EXPECT_EQ(seeds.count(kTruthSeed), 0U);
}

TEST(Budgets, Default) {
  const std::vector<std::uint32_t> budgets = DefaultBudgets();
  EXPECT_EQ(budgets.front(), 16U);
  EXPECT_EQ(budgets[1], 64U);
  EXPECT_EQ(budgets.back(), 16'777'216U);
}

}  // namespace
}  // namespace flatlight
