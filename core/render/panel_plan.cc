// SPDX-License-Identifier: Apache-2.0
#include "core/render/panel_plan.h"

#include <algorithm>
#include <variant>

#include "core/render/plan_text.h"

namespace flatlight {
namespace {

// Of straight and arced pieces: everything that a panel may see is kept, some 100 kB a piece.
constexpr std::size_t kMostReferencePieces = 2048;

}  // namespace

bool PanelsTellAll(const Scene& scene) {
  const SceneTraits& traits = scene.traits();
  return traits.lambertian && !traits.has_beziers && traits.elements <= kMostReferencePieces;
}

void CheckPanels(const Scene& scene, bool reflects, const std::string& path, const std::string& other,
                 Diagnostics& diagnostics) {
  if (reflects && !scene.traits().lambertian) {
    const auto curve = std::find_if(scene.curves().begin(), scene.curves().end(), [](const Curve& c) {
      return !std::holds_alternative<Lambertian>(c.material) && !c.reflectance.IsBlack();
    });
    diagnostics.Add(path, "reference needs a scene that reflects by lambertian materials alone, and curve \"" +
                              curve->name + "\" has another: use " + other);
  }
  if (reflects && scene.traits().elements > kMostReferencePieces) {
    diagnostics.Add(path, "reference does scenes of up to " + Text(kMostReferencePieces) +
                              " straight and arced pieces, and this one has " + Text(scene.traits().elements) +
                              ": use " + other);
  }
}

}  // namespace flatlight
