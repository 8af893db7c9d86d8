// SPDX-License-Identifier: Apache-2.0
// Bounded, repeatable fuzzing of the scene reader and builder with every compiler; scene_reader_fuzz.cc goes further.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "server/gallery/gallery.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/scene_input.h"

namespace flatlight {
namespace {

TEST(SceneMutationTest, GalleryFilesPass) {
  for (const GalleryScene& scene : Gallery()) EXPECT_EQ(TestSceneInput(scene.json), "") << scene.name;
}

using Change = std::string (*)(const std::string&, std::mt19937_64&);

void ExpectPromisesKept(const std::vector<Change>& changes, int texts_per_scene, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (const GalleryScene& scene : Gallery()) {
    for (int i = 0; i < texts_per_scene; ++i) {
      std::string text = scene.json;
      for (const Change change : changes) text = change(text, random);
      const std::string problem = TestSceneInput(text);
      ASSERT_EQ(problem, "") << scene.name << ", text " << i << ":\n" << text;
    }
  }
}

TEST(SceneMutationTest, ChangedTexts) {
  ExpectPromisesKept({WithChangedText}, 1500, 1);
  ExpectPromisesKept({WithChangedText, WithChangedText, WithChangedText}, 1500, 2);
}

TEST(SceneMutationTest, ChangedMeanings) {
  ExpectPromisesKept({WithChangedMeaning}, 1500, 3);
  ExpectPromisesKept({WithChangedMeaning, WithChangedMeaning, WithChangedMeaning}, 1500, 4);
}

TEST(SceneMutationTest, ChangedMeaningsAndTexts) {
  ExpectPromisesKept({WithChangedMeaning, WithChangedMeaning, WithChangedText}, 1500, 5);
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
