// SPDX-License-Identifier: Apache-2.0
#include "server/gallery/gallery.h"

#include <algorithm>

#include "server/gallery/scene_files.h"

namespace flatlight {
namespace {

struct Entry {
  const char* name;  // Of the file in scenes/.
  const char* title;
  const char* description;
};

// In the order in which they are best looked at.
constexpr Entry kEntries[] = {
    {"penumbra", "A lamp, a post and a floor",
     "The shadow of a round post has a soft edge where the lamp is hidden in part, and bounced light fills its core."},
    {"cornell", "Cornell box",
     "Between a red and a green wall two tilted boxes shade the floor, and the walls' colours bleed onto it."},
    {"unit-light", "Unit light",
     "A light of length 1 at height 1 above a black floor: its irradiance has a closed form with no shadow in it."},
    {"blocker", "Unit light with a blocker",
     "A plate below the unit light makes a full shadow, a penumbra and kinks where a visibility event begins or ends."},
    {"furnace", "White furnace",
     "In a closed room whose walls all emit 1 and reflect one half the irradiance is 4 everywhere."},
    {"corner", "Corner",
     "Where a floor and a wall meet, bounced light changes ever faster: cache records must crowd there."},
    {"keyhole", "Keyhole", "All light in the second room comes through a gap of 10 cm, which few random paths find."},
    {"ring", "Sun, moon and crescent in a ring",
     "Round emitters and blockers in a round room: all that works for straight curves must work for arcs."},
    {"caustic", "Caustic of a round cup",
     "A polished half circle gathers a lamp's light in a bright cusp, which only paths that begin at the lamp find "
     "well."},
    {"lens", "Lens with two lamps",
     "Glass gathers the light of each lamp on the other side, and turns the picture over."},
    {"leaf", "Glass leaf",
     "Every edge of a glass leaf bends in its own way, and so the light below gathers in folds and cusps on uneven "
     "ground."},
    {"prism", "Prism", "A beam is bent twice by glass, and what meets the wall beyond came no straight way."},
    {"mirror-corridor", "Corridor of mirrors",
     "Two lamps between two mirrors light the end of the corridor like an endless row of lamps that grow dimmer."},
    {"city", "City in the evening sun",
     "Sun and sky light a street between houses: sharp shadows, soft sky light, and colours from wall to wall."},
    {"nearly-closed", "White room with a slit",
     "Light comes in by a slit of 4 cm and stays for many bounces, so ending paths early costs much of it."},
    {"no-wall", "Lit floor beside nothing",
     "The unit light with a black wall on its left: pair it with black-wall, which looks different and is lit the "
     "same."},
    {"black-wall", "Lit floor beside a black wall",
     "A black wall on the right changes nothing on the floor, so error control that looks only at distances is "
     "misled."},
};

std::vector<GalleryScene> MakeGallery() {
  std::vector<GalleryScene> gallery;
  for (const Entry& entry : kEntries) {
    const auto files = SceneFiles();
    const auto file = std::find_if(files.begin(), files.end(),
                                   [&](const SceneFile& candidate) { return candidate.name == entry.name; });
    gallery.push_back({entry.name, entry.title, entry.description, std::string(file->json)});
  }
  return gallery;
}

}  // namespace

const std::vector<GalleryScene>& Gallery() {
  // Never destroyed: there is no order of exit.
  static const auto& gallery = *new std::vector<GalleryScene>(MakeGallery());
  return gallery;
}

const GalleryScene* FindGalleryScene(std::string_view name) {
  for (const GalleryScene& scene : Gallery()) {
    if (scene.name == name) return &scene;
  }
  return nullptr;
}

}  // namespace flatlight
