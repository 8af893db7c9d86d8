// SPDX-License-Identifier: Apache-2.0
// What must hold for any bytes that claim to be a scene file.
#ifndef FLATLIGHT_TESTS_FUZZ_SCENE_INPUT_H_
#define FLATLIGHT_TESTS_FUZZ_SCENE_INPUT_H_

#include <string>
#include <string_view>

namespace flatlight {

// Reads the bytes and builds the scene. Returns what is wrong with the reader or the builder; empty if nothing is:
// - there is a scene, or there is a mistake with a path and a message fit for the API, never both;
// - a scene that was read comes back the same from the JSON that protobuf prints of it;
// - a scene that was built has only finite, normalised geometry.
std::string TestSceneInput(std::string_view bytes);

}  // namespace flatlight

#endif  // FLATLIGHT_TESTS_FUZZ_SCENE_INPUT_H_
