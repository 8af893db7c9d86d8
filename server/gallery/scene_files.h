// SPDX-License-Identifier: Apache-2.0
// The files of scenes/, as they were when the program was configured.
#ifndef FLATLIGHT_SERVER_GALLERY_SCENE_FILES_H_
#define FLATLIGHT_SERVER_GALLERY_SCENE_FILES_H_

#include <span>
#include <string_view>

namespace flatlight {

struct SceneFile {
  std::string_view name;  // Without folder and ending.
  std::string_view json;
};

// In alphabetical order.
std::span<const SceneFile> SceneFiles();

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_GALLERY_SCENE_FILES_H_
