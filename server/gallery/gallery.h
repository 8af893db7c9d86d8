// SPDX-License-Identifier: Apache-2.0
// The scenes that come with the server, each a scene file built into the program.
#ifndef FLATLIGHT_SERVER_GALLERY_GALLERY_H_
#define FLATLIGHT_SERVER_GALLERY_GALLERY_H_

#include <string>
#include <string_view>
#include <vector>

namespace flatlight {

struct GalleryScene {
  std::string name;         // As in gallery:NAME and scenes/NAME.
  std::string title;        // A few words.
  std::string description;  // What it teaches, one sentence.
  std::string json;         // The scene file.
};

const std::vector<GalleryScene>& Gallery();

// Null if there is none of that name.
const GalleryScene* FindGalleryScene(std::string_view name);

}  // namespace flatlight

#endif  // FLATLIGHT_SERVER_GALLERY_GALLERY_H_
