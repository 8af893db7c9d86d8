// SPDX-License-Identifier: Apache-2.0
#include "server/service/scene_source.h"

#include <algorithm>
#include <string_view>

#include "server/convert/scene_convert.h"
#include "server/convert/scene_reader.h"
#include "server/gallery/gallery.h"
#include "server/service/status_convert.h"
#include "server/store/error.h"
#include "server/store/sha256.h"

namespace flatlight {
namespace {

constexpr std::string_view kPrefix = "scenes/";

// Before anything is built: what a few bytes ask for can be large.
bool WithinLimits(const v1::Scene& scene, const Limits& limits, Diagnostics& diagnostics) {
  bool within = true;
  const auto check = [&](const char* path, const char* what, std::uint64_t number, std::uint64_t limit) {
    if (number <= limit) return;
    diagnostics.Add(path, std::to_string(number) + what + "; allowed: at most " + std::to_string(limit));
    within = false;
  };
  std::uint64_t pieces = 0, points = 0;
  double pixels = 0;  // Sides may have any size still.
  for (const v1::Curve& curve : scene.plane().curves()) {
    pieces += curve.has_polyline() ? static_cast<std::uint64_t>(curve.polyline().points_size()) : 1;
  }
  for (const v1::Probe& probe : scene.probes()) {
    points += probe.count() + static_cast<std::uint64_t>(probe.points_size()) + probe.camera().width();
    pixels += static_cast<double>(probe.fluence().width()) * probe.fluence().height();
  }
  check("plane.curves", " curves and pieces of polylines", pieces, limits.max_curves);
  check("probes", " points in all", points, limits.max_probe_points);
  check("probes", " pixels in all", static_cast<std::uint64_t>(std::min(pixels, 1e18)), limits.max_pixels);
  return within;
}

}  // namespace

std::string SceneIdOf(const std::string& name) { return name.substr(kPrefix.size()); }

absl::StatusOr<NamedScene> FindScene(const std::string& name, SceneStore& scenes) {
  const std::string_view view = name;
  if (!view.starts_with(kPrefix) || view.size() == kPrefix.size() || view.size() > kPrefix.size() + 64) {
    return MakeFieldError("name", "\"" + name + "\"; a scene is named scenes/{gallery name} or scenes/{sha256}");
  }
  const std::string id = SceneIdOf(name);
  NamedScene scene;
  scene.info.set_name(name);
  if (const GalleryScene* gallery = FindGalleryScene(id)) {
    scene.info.set_title(gallery->title);
    scene.info.set_description(gallery->description);
    scene.info.set_gallery(true);
    scene.json = std::shared_ptr<const std::string>(std::shared_ptr<void>(), &gallery->json);
  } else {
    const auto stored = scenes.Get(id);
    if (!stored.ok()) return stored.status();
    scene.info.set_title(stored->title);
    scene.json = stored->bytes;
  }
  scene.info.set_bytes(static_cast<double>(scene.json->size()));
  return scene;
}

absl::StatusOr<NamedScene> FindSeenScene(const Caller& caller, const std::string& name, SceneStore& scenes) {
  // Before it is looked for: what others have takes as long as what nobody has.
  if (name.starts_with(kPrefix) && FindGalleryScene(SceneIdOf(name)) == nullptr) {
    const std::string sha256 = SceneIdOf(name);
    if (IsSha256(sha256) && !MaySeeScene(caller, sha256, scenes)) return NoSuchScene(sha256);
  }
  return FindScene(name, scenes);
}

namespace {

// In place of the scene's own, if there are any.
void ReplaceProbes(const v1::SceneSource& source, v1::Scene& scene) {
  if (!source.probes().empty()) *scene.mutable_probes() = source.probes();
}

absl::StatusOr<std::shared_ptr<const Scene>> LoadNamed(const v1::SceneSource& source, const SceneShelf& shelf,
                                                       const Proceed& proceed, Diagnostics& diagnostics) {
  const std::string& name = source.name();
  const auto named = FindSeenScene(shelf.caller, name, shelf.uploads);
  if (!named.ok()) return named.status();
  const std::string id = name.substr(kPrefix.size());
  const bool as_stored = source.probes().empty();
  if (auto built = as_stored ? shelf.built.Get(shelf.caller.name, id) : nullptr) {
    shelf.uploads.SetTitle(shelf.caller.name, id, built->name());  // The file may have been deleted and uploaded again.
    return built;
  }
  if (absl::Status wanted = proceed(); !wanted.ok()) return wanted;
  v1::Scene proto;
  ReadSceneJson(*named->json, proto, diagnostics);  // Mistakes of form do not hide those of meaning.
  if (!named->info.gallery()) shelf.uploads.SetTitle(shelf.caller.name, id, proto.name());
  ReplaceProbes(source, proto);
  if (!WithinLimits(proto, shelf.limits, diagnostics)) return nullptr;
  if (absl::Status wanted = proceed(); !wanted.ok()) return wanted;
  auto scene = SceneFromProto(proto, diagnostics);
  if (scene != nullptr && as_stored && !named->info.gallery()) shelf.built.Put(shelf.caller.name, id, scene);
  return scene;
}

std::shared_ptr<const Scene> LoadInline(const v1::SceneSource& source, const Limits& limits, Diagnostics& diagnostics) {
  if (source.probes().empty()) {
    return WithinLimits(source.scene(), limits, diagnostics) ? SceneFromProto(source.scene(), diagnostics) : nullptr;
  }
  v1::Scene scene = source.scene();
  ReplaceProbes(source, scene);
  return WithinLimits(scene, limits, diagnostics) ? SceneFromProto(scene, diagnostics) : nullptr;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Scene>> LoadScene(const v1::SceneSource& source, const SceneShelf& shelf,
                                                       const Proceed& proceed, Diagnostics& diagnostics) {
  absl::StatusOr<std::shared_ptr<const Scene>> scene;
  switch (source.source_case()) {
    case v1::SceneSource::kScene:
      if (absl::Status wanted = proceed(); !wanted.ok()) return wanted;
      scene = LoadInline(source, shelf.limits, diagnostics);
      break;
    case v1::SceneSource::kName:
      scene = LoadNamed(source, shelf, proceed, diagnostics);
      break;
    case v1::SceneSource::SOURCE_NOT_SET:
      return MakeFieldError("scene", "missing; give a name (scenes/{scene}) or a scene");
  }
  if (absl::Status wanted = proceed(); !wanted.ok()) return wanted;
  return scene;
}

}  // namespace flatlight
