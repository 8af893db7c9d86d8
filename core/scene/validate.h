// SPDX-License-Identifier: Apache-2.0
#ifndef FLATLIGHT_CORE_SCENE_VALIDATE_H_
#define FLATLIGHT_CORE_SCENE_VALIDATE_H_

#include "core/scene/description.h"
#include "core/scene/diagnostic.h"

namespace flatlight {

// What a scene may hold.
struct SceneLimits {
  std::size_t max_curves = 4'000'000;
  std::size_t max_elements = 16'000'000;  // Straight pieces; arcs count as up to 5, Béziers as 256.
  std::size_t max_probe_points = 1'000'000;
  std::uint32_t max_picture_side = 16'384;        // Pixels.
  std::size_t max_pixels = std::size_t{2} << 20;  // Of all pictures.
  double max_coordinate = 1e100;                  // m, of any coordinate and radius.
  double max_radiance = 1e100;                    // W/(rad m); also of power, W, and of irradiance, W/m.
  std::size_t max_lights = 10'000;
  std::size_t max_name_bytes = 1000;  // Of the scene's name: every job and list that tells of it has it.
};

// Reports every mistake of a description: ranges, names, shapes.
void ValidateScene(const SceneDescription& description, const SceneLimits& limits, Diagnostics& diagnostics);

}  // namespace flatlight

#endif  // FLATLIGHT_CORE_SCENE_VALIDATE_H_
