// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/cli/formats/gnuplot.h"
#include "client/cli/formats/plot_script.h"
#include "client/cli/formats/plot_series.h"
#include "tests/client/cli/formats/sample_result.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;

std::string Draw(const v1::RenderResult& result) {
  const auto picture = RunGnuplot(PlotScript(result, PlotForm::kSvg));
  EXPECT_TRUE(picture.ok()) << picture.status();
  return picture.ok() ? *picture : "";
}

TEST(Plot, NamesAreTextNotCommands) {
  v1::RenderResult result;
  result.set_scene("it's `exit`; ' . system('exit 3') . ' {/:Bold x}_^@&~\\ \n end");
  AddProbe(result, "'; exit status 3 #", 5);
  AddProbe(result, "$irradiance0 << EOD", 5);
  const std::string svg = Draw(result);
  EXPECT_THAT(svg, HasSubstr("exit status 3"));
  EXPECT_THAT(svg, HasSubstr("`exit`"));
}

TEST(Plot, DegenerateResultsAreDrawn) {
  v1::RenderResult none;
  Draw(none);
  v1::RenderResult empty;
  AddProbe(empty, "empty", 0);
  Draw(empty);
  v1::RenderResult dark;
  AddProbe(dark, "dark", 1).set_irradiance(0, 0);
  Draw(dark);
  v1::RenderResult huge;
  v1::ProbeResult& probe = AddProbe(huge, "huge", 3, 3);
  for (double& value : *probe.mutable_irradiance()) value = 1e300;
  Draw(huge);
}

TEST(Plot, HasAPanelForEachDerivativeAndABandForErrors) {
  v1::RenderResult result;
  v1::ProbeResult& probe = AddProbe(result, "floor", 9);
  EXPECT_THAT(Draw(result), Not(HasSubstr("standard errors")));
  for (int i = 0; i < 9; ++i) {
    probe.add_standard_error(0.1);
    probe.add_gradient(i);
    probe.add_hessian(-i);
  }
  const std::string svg = Draw(result);
  for (const char* text : {"2 standard errors", "dE/ds", "arc length", "W/m"}) EXPECT_THAT(svg, HasSubstr(text));
}

TEST(Plot, GnuplotsComplaintsAreReported) {
  const auto picture = RunGnuplot("plot nonsense(1)\n");
  ASSERT_FALSE(picture.ok());
  EXPECT_THAT(std::string(picture.status().message().data(), picture.status().message().size()),
              HasSubstr("undefined function"));
}

TEST(PlotSeries, ThinningKeepsPeaksAndOrder) {
  std::vector<PlotPoint> points(10000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].place = static_cast<double>(i);
  points[1234].value = 7;
  points[8765].value = -7;
  const std::vector<PlotPoint> thinned = Thinned(points, 100);
  EXPECT_LE(thinned.size(), 100U);
  double low = 0, high = 0, last = -1;
  for (const PlotPoint& point : thinned) {
    low = std::min(low, point.value);
    high = std::max(high, point.value);
    EXPECT_GT(point.place, last);
    last = point.place;
  }
  EXPECT_EQ(high, 7);
  EXPECT_EQ(low, -7);
  EXPECT_EQ(Thinned(points, 10000).size(), 10000U);
}

TEST(PlotSeries, PointsWithoutSamplesAreNotDrawn) {
  v1::RenderResult result;
  v1::ProbeResult& probe = AddProbe(result, "floor", 3);
  for (const double samples : {16, 0, 16}) probe.add_samples(samples);
  const auto series = PlotSeriesOf(result, {"irradiance", "standardError", ""});
  ASSERT_EQ(series.size(), 1u);
  ASSERT_EQ(series[0].points.size(), 2u);
  EXPECT_EQ(series[0].points[1].place, 2.5);
}

TEST(PlotSeries, PointsWithoutArcLengthAreNumbered) {
  v1::RenderResult result;
  AddProbe(result, "free", 3).clear_arc_length();
  EXPECT_FALSE(HasArcLengths(result));
  const auto series = PlotSeriesOf(result, {"irradiance", "standardError", ""});
  ASSERT_EQ(series.size(), 1U);
  EXPECT_EQ(series[0].points[2].place, 2);
}

TEST(PlotSeries, CamerasAreShownOverTheAngle) {
  v1::RenderResult result;
  v1::ProbeResult& camera = AddProbe(result, "eye", 3);
  camera.clear_arc_length();
  EXPECT_FALSE(HasCamerasAlone(result));
  camera.set_quantity(v1::ProbeResult::RADIANCE);
  camera.set_width(3);
  camera.set_height(1);
  camera.clear_normals();
  for (const double component : {0.6, 0.8, 1.0, 0.0, 0.6, -0.8}) camera.add_normals(component);
  EXPECT_TRUE(HasCamerasAlone(result));
  EXPECT_FALSE(IsPicture(camera));
  const auto series = PlotSeriesOf(result, {"irradiance", "standardError", ""});
  ASSERT_EQ(series.size(), 1U);
  EXPECT_NEAR(series[0].points[0].place, -53.13, 0.01);
  EXPECT_NEAR(series[0].points[1].place, 0, 1e-12);
  EXPECT_NEAR(series[0].points[2].place, 53.13, 0.01);
}

}  // namespace
}  // namespace flatlight
