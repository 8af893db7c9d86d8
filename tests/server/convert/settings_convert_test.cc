// SPDX-License-Identifier: Apache-2.0
#include "server/convert/settings_convert.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "core/render/plan.h"
#include "core/render/settings.h"
#include "flatlight/v1/settings.pb.h"

namespace flatlight {
namespace {

using google::protobuf::util::MessageDifferencer;
using testing::ElementsAre;
using testing::HasSubstr;

v1::Settings EverySetting() {
  v1::Settings proto;
  proto.set_method(v1::Settings::PATH_TRACING);
  proto.set_samples(64);
  proto.set_max_bounces(0);
  proto.set_seed(7);
  proto.set_derivatives(v1::Settings::GRADIENT);
  proto.set_formulation(v1::Settings::POLYLINE);
  proto.set_target_error(0.01);
  proto.set_time_limit(2.5);
  proto.set_threads(3);
  proto.set_error_control(v1::Settings::OCCLUSION_HESSIAN);
  proto.set_gather(v1::Settings::FROM_RAY_TRACING);
  proto.set_extrapolation(0);
  proto.set_tolerance(0.03);
  proto.set_max_records(12);
  proto.set_neighbour_clamping(true);
  proto.set_overture(false);
  proto.set_photons(13);
  proto.set_final_gather(false);
  proto.set_bandwidth(0.25);
  proto.set_neighbours(14);
  proto.set_kernel(v1::Settings::BIWEIGHT);
  proto.add_no_skip("colour");
  proto.add_no_skip("visibility");
  return proto;
}

TEST(SettingsConvertTest, EverySettingComesBack) {
  Diagnostics diagnostics;
  const Settings settings = SettingsFromProto(EverySetting(), diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_EQ(settings.method, Method::kPathTracing);
  EXPECT_EQ(settings.samples, 64U);
  EXPECT_EQ(settings.max_bounces, 0U);
  EXPECT_EQ(settings.seed, 7U);
  EXPECT_EQ(settings.derivatives, Derivatives::kGradient);
  EXPECT_EQ(settings.formulation, Formulation::kPolyline);
  EXPECT_EQ(settings.target_error, 0.01);
  EXPECT_EQ(settings.time_limit, 2.5);
  EXPECT_EQ(settings.threads, 3U);
  EXPECT_EQ(settings.error_control, ErrorControl::kOcclusionHessian);
  EXPECT_EQ(settings.gather, Gather::kRayTracing);
  EXPECT_EQ(settings.extrapolation, 0U);
  EXPECT_EQ(settings.tolerance, 0.03);
  EXPECT_EQ(settings.max_records, 12U);
  EXPECT_EQ(settings.neighbour_clamping, true);
  EXPECT_EQ(settings.overture, false);
  EXPECT_EQ(settings.photons, 13U);
  EXPECT_EQ(settings.final_gather, false);
  EXPECT_EQ(settings.bandwidth, 0.25);
  EXPECT_EQ(settings.neighbours, 14U);
  EXPECT_EQ(settings.kernel, Kernel::kBiweight);
  EXPECT_THAT(settings.no_skip, ElementsAre("colour", "visibility"));
  EXPECT_TRUE(MessageDifferencer::Equals(SettingsToProto(settings), EverySetting()));
}

// A field that is added to the API and forgotten here would not come back.
TEST(SettingsConvertTest, TheTestNamesEverySetting) {
  const v1::Settings proto = EverySetting();
  std::vector<const google::protobuf::FieldDescriptor*> set;
  proto.GetReflection()->ListFields(proto, &set);
  EXPECT_EQ(static_cast<int>(set.size()), proto.GetDescriptor()->field_count());
}

TEST(SettingsConvertTest, WhatIsAbsentStaysAbsent) {
  Diagnostics diagnostics;
  const Settings settings = SettingsFromProto(v1::Settings(), diagnostics);
  EXPECT_TRUE(diagnostics.empty());
  EXPECT_FALSE(settings.method || settings.samples || settings.max_bounces || settings.seed || settings.derivatives ||
               settings.target_error || settings.time_limit || settings.threads || settings.error_control ||
               settings.gather || settings.extrapolation || settings.tolerance || settings.max_records);
  EXPECT_FALSE(settings.photons || settings.final_gather || settings.bandwidth || settings.neighbours ||
               settings.kernel);
  EXPECT_TRUE(MessageDifferencer::Equals(SettingsToProto(settings), v1::Settings()));
}

TEST(SettingsConvertTest, EveryMethodAndEveryOrderOfDerivativesComesBack) {
  for (const auto method : {v1::Settings::EXACT, v1::Settings::PATH_TRACING, v1::Settings::RAY_TRACING,
                            v1::Settings::REFERENCE, v1::Settings::IRRADIANCE_CACHING, v1::Settings::PHOTON_MAPPING}) {
    for (const auto derivatives : {v1::Settings::NONE, v1::Settings::GRADIENT, v1::Settings::HESSIAN}) {
      v1::Settings proto;
      proto.set_method(method);
      proto.set_derivatives(derivatives);
      Diagnostics diagnostics;
      EXPECT_TRUE(MessageDifferencer::Equals(SettingsToProto(SettingsFromProto(proto, diagnostics)), proto));
      EXPECT_TRUE(diagnostics.empty());
    }
  }
}

TEST(SettingsConvertTest, EveryErrorControlAndEveryGatherComesBack) {
  for (int control = v1::Settings::SPLIT_SPHERE; control <= v1::Settings::ErrorControl_MAX; ++control) {
    for (const auto gather :
         {v1::Settings::FROM_REFERENCE, v1::Settings::FROM_RAY_TRACING, v1::Settings::FROM_PHOTON_MAP}) {
      v1::Settings proto;
      proto.set_error_control(static_cast<v1::Settings::ErrorControl>(control));
      proto.set_gather(gather);
      Diagnostics diagnostics;
      EXPECT_TRUE(MessageDifferencer::Equals(SettingsToProto(SettingsFromProto(proto, diagnostics)), proto));
    }
  }
}

TEST(SettingsConvertTest, EveryFormulationComesBack) {
  for (const auto formulation : {v1::Settings::STRATIFIED, v1::Settings::POLYLINE, v1::Settings::ARC_LENGTH}) {
    v1::Settings proto;
    proto.set_formulation(formulation);
    Diagnostics diagnostics;
    EXPECT_TRUE(MessageDifferencer::Equals(SettingsToProto(SettingsFromProto(proto, diagnostics)), proto));
  }
}

TEST(SettingsConvertTest, RefusesWhatAnotherVersionMeant) {
  v1::Settings proto;
  proto.set_method(static_cast<v1::Settings::Method>(42));
  proto.GetReflection()->MutableUnknownFields(&proto)->AddVarint(77, 1);
  Diagnostics diagnostics;
  SettingsFromProto(proto, diagnostics);
  ASSERT_EQ(diagnostics.count(), 2U);
  EXPECT_EQ(diagnostics.kept()[0].path, "settings.77");
  EXPECT_EQ(diagnostics.kept()[1].path, "settings.method");
  EXPECT_THAT(diagnostics.kept()[1].message, HasSubstr("42"));
  EXPECT_THAT(diagnostics.kept()[1].message, HasSubstr("EXACT, PATH_TRACING, RAY_TRACING, REFERENCE"));
}

TEST(SettingsConvertTest, APlanKeepsItsReasons) {
  Plan plan;
  plan.settings.samples = 16;
  plan.skips = {{"colour", SkipDecision::kTaken, "all spectra are grey"},
                {"visibility", SkipDecision::kNotApplicable, "a post blocks"},
                {"bounces", SkipDecision::kDisabled, "no_skip names it"}};
  plan.passes = {{"paths", 256, 16, 8192}};
  plan.summary = "16 paths a point.";
  const v1::Plan proto = PlanToProto(plan);
  EXPECT_EQ(proto.settings().samples(), 16U);
  EXPECT_EQ(proto.summary(), plan.summary);
  ASSERT_EQ(proto.skips_size(), 3);
  EXPECT_EQ(proto.skips(0).name(), "colour");
  EXPECT_EQ(proto.skips(0).decision(), v1::Plan::Skip::TAKEN);
  EXPECT_EQ(proto.skips(0).reason(), "all spectra are grey");
  EXPECT_EQ(proto.skips(1).decision(), v1::Plan::Skip::NOT_APPLICABLE);
  EXPECT_EQ(proto.skips(2).decision(), v1::Plan::Skip::DISABLED);
  ASSERT_EQ(proto.passes_size(), 1);
  EXPECT_EQ(proto.passes(0).name(), "paths");
  EXPECT_EQ(proto.passes(0).points(), 256);
  EXPECT_EQ(proto.passes(0).samples(), 16);
  EXPECT_EQ(proto.passes(0).expected_rays(), 8192);
}

}  // namespace
}  // namespace flatlight
