// SPDX-License-Identifier: Apache-2.0
// Bounded, repeatable fuzzing of the scene reader and builder with every compiler; scene_reader_fuzz.cc goes further.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "server/gallery/gallery.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/scene_input.h"

namespace flatlight {
namespace {

TEST(SceneMutationTest, GalleryFilesPass) {
  for (const GalleryScene& scene : Gallery()) EXPECT_EQ(TestSceneInput(scene.json), "") << scene.name;
}

TEST(SceneMutationTest, MutatedGalleryFilesKeepTheReadersPromises) {
  constexpr int kTextsPerScene = 8000;
  constexpr int kMostChanges = 6;
  std::mt19937_64 random(20120806);
  for (const GalleryScene& scene : Gallery()) {
    for (int i = 0; i < kTextsPerScene; ++i) {
      std::string text = scene.json;
      const int changes = 1 + i % kMostChanges;
      for (int change = 0; change < changes; ++change) text = Mutated(text, random);
      const std::string problem = TestSceneInput(text);
      ASSERT_EQ(problem, "") << scene.name << ", text " << i << ":\n" << text;
    }
  }
}

TEST(SceneMutationTest, RubbishIsRefused) {
  std::mt19937_64 random(19940624);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 64, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    ASSERT_EQ(TestSceneInput(bytes), "") << testing::PrintToString(bytes);
  }
}

}  // namespace
}  // namespace flatlight
