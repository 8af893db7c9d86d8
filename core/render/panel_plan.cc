// SPDX-License-Identifier: Apache-2.0
#include "core/render/panel_plan.h"

#include <string>
#include <variant>

#include "core/render/plan_text.h"

namespace flatlight {
namespace {

// Of straight and arced pieces: everything that a panel may see is kept, some 100 kB a piece.
constexpr std::size_t kMostReferencePieces = 2048;

void CheckCount(const Scene& scene, const std::string& path, const std::string& other, Diagnostics& diagnostics) {
  if (scene.traits().elements <= kMostReferencePieces) return;
  diagnostics.Add(path, "reference does scenes of up to " + Text(kMostReferencePieces) +
                            " straight and arced pieces, and this one has " + Text(scene.traits().elements) + ": use " +
                            other);
}

// Of the first curve that reflects by such a material; empty if there is none.
template <typename Is>
std::string NameOfCurve(const Scene& scene, const Is& is) {
  for (const Curve& curve : scene.curves())
    if (!curve.reflectance.IsBlack() && is(curve.material)) return curve.name;
  return {};
}

bool IsConductor(const Material& material) { return std::holds_alternative<Conductor>(material); }

void CheckGlossy(const Scene& scene, const std::string& path, const std::string& glossy, const std::string& other,
                 Diagnostics& diagnostics) {
  const std::string specular = NameOfCurve(scene, IsSpecular);
  if (!specular.empty()) {
    diagnostics.Add(path, "reference does phong lobes, of which curve \"" + glossy +
                              "\" is one, where nothing is a mirror or glass, and curve \"" + specular + "\" is: use " +
                              other);
  }
  if (scene.traits().has_beziers) {
    diagnostics.Add(path, "reference does scenes with Bézier curves where nothing is a phong lobe, and curve \"" +
                              glossy + "\" is one: use " + other);
  }
}

}  // namespace

std::string NameOfPhongCurve(const Scene& scene) {
  return NameOfCurve(scene, [](const Material& material) { return std::holds_alternative<Phong>(material); });
}

bool PanelsTellAll(const Scene& scene) {
  const SceneTraits& traits = scene.traits();
  return traits.lambertian && !traits.has_beziers && traits.elements <= kMostReferencePieces;
}

void CheckPanelDerivatives(const Scene& scene, const std::string& path, const std::string& other,
                           Diagnostics& diagnostics) {
  const std::string curve =
      NameOfCurve(scene, [](const Material& material) { return !std::holds_alternative<Lambertian>(material); });
  if (!scene.traits().lambertian) {
    diagnostics.Add(path,
                    "reference gives derivatives in scenes that reflect by lambertian materials alone, and curve "
                    "\"" +
                        curve + "\" has another: use " + other);
  } else if (scene.traits().has_beziers) {
    diagnostics.Add(path,
                    "reference gives no derivatives of light reflected in a scene with Bézier curves: use " + other);
  }
  CheckCount(scene, path, other, diagnostics);
}

void CheckPanels(const Scene& scene, const std::string& path, const std::string& other, Diagnostics& diagnostics) {
  CheckCount(scene, path, other, diagnostics);
  if (scene.traits().lambertian) return;
  const std::string conductor = NameOfCurve(scene, IsConductor);
  if (!conductor.empty()) {
    diagnostics.Add(path, "reference does lambertian, phong, mirror and dielectric materials, and curve \"" +
                              conductor + "\" has another: use " + other);
    return;
  }
  const std::string glossy = NameOfPhongCurve(scene);
  if (!glossy.empty()) return CheckGlossy(scene, path, glossy, other, diagnostics);
  const std::string specular = NameOfCurve(scene, IsSpecular);
  if (!scene.lights().empty()) {
    diagnostics.Add(path, "reference leaves out what plane.lights send over mirrors and glass, and curve \"" +
                              specular + "\" is one: use " + other);
  }
}

}  // namespace flatlight
