// SPDX-License-Identifier: Apache-2.0
#include "server/gallery/gallery.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

#include "core/scene/scene.h"
#include "flatlight/v1/scene.pb.h"
#include "server/convert/scene_convert.h"
#include "server/convert/scene_reader.h"
#include "server/gallery/scene_files.h"

namespace flatlight {
namespace {

using google::protobuf::util::MessageDifferencer;
using testing::EndsWith;
using testing::IsEmpty;
using testing::Not;

std::shared_ptr<const Scene> Build(const std::string& name) {
  v1::Scene proto;
  Diagnostics diagnostics;
  const auto scene = SceneFromJson(FindGalleryScene(name)->json, proto, diagnostics);
  for (const Diagnostic& mistake : diagnostics.kept()) {
    ADD_FAILURE() << name << ": " << mistake.path << ": " << mistake.message;
  }
  return scene;
}

TEST(GalleryTest, EveryFileHasAnEntryAndEveryEntryAFile) {
  std::set<std::string> entries;
  for (const GalleryScene& scene : Gallery()) {
    EXPECT_TRUE(entries.insert(scene.name).second) << scene.name << " twice";
  }
  std::set<std::string> files;
  for (const SceneFile& file : SceneFiles()) files.emplace(file.name);
  EXPECT_EQ(entries, files);
  EXPECT_GE(entries.size(), 16U);
}

TEST(GalleryTest, EveryEntrySaysWhatItTeachesInOneSentence) {
  for (const GalleryScene& scene : Gallery()) {
    EXPECT_THAT(scene.title, Not(IsEmpty()));
    EXPECT_LE(scene.title.size(), 40U) << scene.title;
    EXPECT_THAT(scene.description, EndsWith(".")) << scene.name;
    EXPECT_EQ(scene.description.find(". "), std::string::npos) << scene.description;
  }
}

TEST(GalleryTest, EverySceneIsValidAndNamedLikeItsFile) {
  for (const GalleryScene& entry : Gallery()) {
    const auto scene = Build(entry.name);
    ASSERT_NE(scene, nullptr) << entry.name;
    EXPECT_EQ(scene->name(), entry.name);
    EXPECT_TRUE(scene->traits().emitting_curves > 0 || !scene->environment().IsBlack()) << entry.name;
    EXPECT_GE(scene->traits().probe_points, 200U) << entry.name;
  }
}

TEST(GalleryTest, EverySceneComesBackFromItsPrint) {
  for (const GalleryScene& entry : Gallery()) {
    v1::Scene scene;
    v1::Scene again;
    std::string json;
    Diagnostics diagnostics;
    ASSERT_TRUE(ReadSceneJson(entry.json, scene, diagnostics));
    ASSERT_TRUE(google::protobuf::util::MessageToJsonString(scene, &json).ok());
    ASSERT_TRUE(ReadSceneJson(json, again, diagnostics)) << json;
    EXPECT_TRUE(MessageDifferencer::Equals(scene, again)) << json;
  }
}

TEST(GalleryTest, WhatTheScenesAreThereFor) {
  EXPECT_EQ(Build("unit-light")->traits().max_reflectance, 0);
  EXPECT_EQ(Build("blocker")->traits().max_reflectance, 0);
  EXPECT_EQ(Build("penumbra")->traits().max_reflectance, 0.8);
  EXPECT_TRUE(Build("penumbra")->traits().has_arcs);
  EXPECT_TRUE(Build("ring")->traits().has_arcs);
  EXPECT_EQ(Build("cornell")->channels(), 3);
  EXPECT_FALSE(Build("caustic")->traits().lambertian);
  EXPECT_FALSE(Build("lens")->traits().lambertian);
  EXPECT_FALSE(Build("prism")->traits().lambertian);
  EXPECT_FALSE(Build("mirror-corridor")->traits().lambertian);
  EXPECT_EQ(Build("city")->traits().lights, 1U);
  EXPECT_TRUE(Build("nearly-closed")->traits().environment);
  const auto furnace = Build("furnace");
  for (const Curve& curve : furnace->curves()) EXPECT_TRUE(curve.Emits());
  // Two scenes that differ in a wall and ask for the same points.
  EXPECT_NE(Build("black-wall")->world_hash(), Build("no-wall")->world_hash());
  EXPECT_EQ(Build("black-wall")->probe_hash(), Build("no-wall")->probe_hash());
}

TEST(GalleryTest, FindsByNameOnly) {
  ASSERT_NE(FindGalleryScene("penumbra"), nullptr);
  EXPECT_EQ(FindGalleryScene("penumbra")->name, "penumbra");
  EXPECT_EQ(FindGalleryScene("Penumbra"), nullptr);
  EXPECT_EQ(FindGalleryScene(""), nullptr);
}

}  // namespace
}  // namespace flatlight
