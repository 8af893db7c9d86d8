// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/stress/families.h"

#include <algorithm>
#include <array>

#include "tests/bench/stress/family_parts.h"

namespace flatlight::stress {

const std::vector<Family>& Families() {
  static const auto& families = *new std::vector<Family>{
      {"scatter", Scatter},
      {"grid", Grid},
      {"grid arcs", GridArcs},
      {"polygons", Polygons},
      {"arcs", Arcs},
      {"beziers", Beziers},
      {"nested", Nested},
      {"cluster", Cluster},
      {"slivers", Slivers},
      {"fan", Fan},
      {"overlaps", Overlaps},
      {"junctions", Junctions},
      {"keyhole", Keyhole},
      {"sizes", Sizes},
      {"wide arcs", WideArcs},
      {"corners", Corners},
      {"grazing", Grazing},
      {"tangents", Tangents},
      {"closed room", ClosedRoom},
      {"closed junctions", ClosedJunctions},
      {"closed arcs", ClosedArcs},
      {"closed beziers", ClosedBeziers},
      {"crowd", Crowd, Crowding::kHundreds},
      {"pencil", Pencil, Crowding::kHundreds},
      {"one line", OneLine, Crowding::kHundreds},
      {"wide pencil", WidePencil, Crowding::kThousands},
      {"wide line", WideLine, Crowding::kThousands},
  };
  return families;
}

SceneDescription MakeScene(const Family& family, std::uint64_t seed, std::uint64_t number) {
  // By name, so that a family's scenes stay the same as others come and go.
  std::uint64_t hash = seed;
  for (const char c : family.name) hash = Mixed(hash, static_cast<unsigned char>(c));
  Random random(Mixed(hash, number));
  SceneDescription scene = family.make(random);
  scene.name = family.name;
  return scene;
}

bool IsClosed(const SceneDescription& scene) { return scene.name.starts_with("closed"); }

bool HasOverlaps(const SceneDescription& scene) {
  constexpr std::array kFamilies{"overlaps", "one line", "wide line", "grid", "grid arcs", "crowd"};
  return std::find(kFamilies.begin(), kFamilies.end(), scene.name) != kFamilies.end();
}

bool IsOnGrid(const SceneDescription& scene) { return scene.name == "grid" || scene.name == "grid arcs"; }

}  // namespace flatlight::stress
