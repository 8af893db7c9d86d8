// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "client/cli/bench/report/bench_json.h"
#include "client/cli/bench/report/bench_text.h"
#include "client/cli/bench/report/error_plot.h"
#include "client/cli/bench/report/versus_text.h"
#include "client/cli/formats/gnuplot.h"
#include "tests/client/cli/bench/sample_rows.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<BenchRow> Rows(const std::string& scene = "s") {
  std::vector<BenchRow> rows = {ExactRow(scene, 0, 1e-3), ExactRow(scene, 1, 1e-3)};
  for (const std::uint32_t budget : {16U, 64U, 256U, 1024U})
    for (const std::uint32_t seed : {1U, 2U, 3U})
      rows.push_back(SampleRow(scene, budget, seed, 1e-3 * budget, (1 + 0.1 * seed) / budget));
  return rows;
}

std::string Draw(const std::vector<Curve>& curves, PlotForm form) {
  const auto picture = RunGnuplot(ErrorPlotScript(curves, form));
  EXPECT_TRUE(picture.ok()) << picture.status();
  return picture.ok() ? *picture : "";
}

TEST(BenchReport, TablesSayIt) {
  const std::string text = BenchText(CurvesOf(Rows()), Rows());
  EXPECT_THAT(text, HasSubstr("s      path-tracing  64      3"));
  EXPECT_THAT(text, HasSubstr("-1.00 +- 0.00"));
  EXPECT_THAT(text, HasSubstr("4 processors, 2 threads; server 1+b; truth exact"));
  EXPECT_THAT(text, Not(HasSubstr("gradient")));  // Without error, like exact itself.
  EXPECT_EQ(BenchText({}, {}), "no runs\n");
}

TEST(BenchReport, JsonHasTheSame) {
  const auto json = nlohmann::json::parse(BenchJson(CurvesOf(Rows()), Rows()));
  const auto& curve = json["curves"][2];
  EXPECT_EQ(curve["method"], "path-tracing");
  EXPECT_EQ(curve["points"].size(), 4U);
  EXPECT_NEAR(curve["slopeOverTime"]["slope"].get<double>(), -1, 1e-9);
  EXPECT_EQ(curve["timeTo"][0]["source"], "MEASURED");
  EXPECT_EQ(json["machine"]["processors"], 4);
}

TEST(BenchReport, TimesTo) {
  using Source = TimeTo::Source;
  EXPECT_EQ(TimeToText({Source::kMeasured, 0.5}), "500 ms");
  EXPECT_EQ(TimeToText({Source::kAtMost, 0.5}), "< 500 ms");
  EXPECT_EQ(TimeToText({Source::kExtrapolated, 200}), "~ 3:20");
  EXPECT_EQ(TimeToText({}), "-");
}

TEST(ErrorPlot, IsDrawn) {
  const std::string svg = Draw(CurvesOf(Rows("it's {a} scene_1")), PlotForm::kSvg);
  EXPECT_THAT(svg, HasSubstr("Error against time"));
  EXPECT_THAT(svg, HasSubstr("path-tracing, slope -1.00 ± 0.00"));
  EXPECT_THAT(svg, HasSubstr("exact, no error seen"));
  EXPECT_THAT(Draw(CurvesOf(Rows()), PlotForm::kPng), HasSubstr("PNG"));
}

TEST(ErrorPlot, DegenerateCurvesAreDrawn) {
  Draw({}, PlotForm::kSvg);
  Draw(CurvesOf({ExactRow("s", 0, 1)}), PlotForm::kSvg);
  Draw(CurvesOf({ExactRow("s", 0, 0)}), PlotForm::kSvg);
  Draw(CurvesOf({SampleRow("s", 16, 1, 1, 0.1)}), PlotForm::kSvg);
  Draw(CurvesOf({SampleRow("s", 16, 1, 0, 0.1)}), PlotForm::kSvg);
  std::vector<BenchRow> many;
  for (int i = 0; i < 11; ++i)
    for (const BenchRow& row : Rows("scene " + std::to_string(i))) many.push_back(row);
  EXPECT_THAT(Draw(CurvesOf(many), PlotForm::kSvg), HasSubstr("scene 10"));
}

TEST(VersusReport, TextAndJson) {
  std::vector<BenchRow> slower = Rows();
  for (BenchRow& row : slower) row.cpu_seconds *= 2;
  const auto versus = CompareBenches(Rows(), slower, {});
  ASSERT_TRUE(versus.ok()) << versus.status();
  const std::string text = VersusText(*versus, {});
  EXPECT_THAT(text, HasSubstr("path-tracing    16      3, 3       2         1          0.5             worse"));
  EXPECT_THAT(text, HasSubstr("5 points: 5 worse, 0 better"));
  EXPECT_THAT(text, HasSubstr("Changes below 5.0 % do not count"));
  const auto json = nlohmann::json::parse(VersusJson(*versus));
  EXPECT_EQ(json["overall"]["verdict"], "worse");
  EXPECT_NEAR(json["points"][1]["time"]["ratio"].get<double>(), 2, 1e-12);
}

}  // namespace
}  // namespace flatlight
