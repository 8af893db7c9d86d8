// SPDX-License-Identifier: Apache-2.0
#include "server/service/scene_source.h"

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
  std::uint64_t pieces = 0;
  for (const v1::Curve& curve : scene.plane().curves()) {
    pieces += curve.has_polyline() ? static_cast<std::uint64_t>(curve.polyline().points_size()) : 1;
  }
  if (pieces > limits.max_curves) {
    diagnostics.Add("plane.curves", std::to_string(pieces) + " curves and pieces of polylines; allowed: at most " +
                                        std::to_string(limits.max_curves));
  }
  std::uint64_t points = 0;
  for (const v1::Probe& probe : scene.probes()) {
    points += probe.count() + static_cast<std::uint64_t>(probe.points_size());
  }
  if (points > limits.max_probe_points) {
    diagnostics.Add("probes", std::to_string(points) + " points in all; allowed: at most " +
                                  std::to_string(limits.max_probe_points));
  }
  return pieces <= limits.max_curves && points <= limits.max_probe_points;
}

}  // namespace

absl::StatusOr<NamedScene> FindScene(const std::string& name, SceneStore& scenes) {
  const std::string_view view = name;
  if (!view.starts_with(kPrefix) || view.size() == kPrefix.size() || view.size() > kPrefix.size() + 64) {
    return MakeFieldError("name", "\"" + name + "\"; a scene is named scenes/{gallery name} or scenes/{sha256}");
  }
  const std::string id(view.substr(kPrefix.size()));
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

namespace {

absl::StatusOr<std::shared_ptr<const Scene>> LoadNamed(const std::string& name, const SceneShelf& shelf,
                                                       const Proceed& proceed, Diagnostics& diagnostics) {
  const auto named = FindScene(name, shelf.uploads);
  if (!named.ok()) return named.status();
  const std::string id = name.substr(kPrefix.size());
  if (auto built = shelf.built.Get(id)) {
    shelf.uploads.SetTitle(id, built->name());  // The file may have been deleted and uploaded again.
    return built;
  }
  if (absl::Status wanted = proceed(); !wanted.ok()) return wanted;
  v1::Scene proto;
  ReadSceneJson(*named->json, proto, diagnostics);  // Mistakes of form do not hide those of meaning.
  if (!named->info.gallery()) shelf.uploads.SetTitle(id, proto.name());
  if (!WithinLimits(proto, shelf.limits, diagnostics)) return nullptr;
  if (absl::Status wanted = proceed(); !wanted.ok()) return wanted;
  auto scene = SceneFromProto(proto, diagnostics);
  if (scene != nullptr && !named->info.gallery()) shelf.built.Put(id, scene);
  return scene;
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Scene>> LoadScene(const v1::SceneSource& source, const SceneShelf& shelf,
                                                       const Proceed& proceed, Diagnostics& diagnostics) {
  absl::StatusOr<std::shared_ptr<const Scene>> scene;
  switch (source.source_case()) {
    case v1::SceneSource::kScene:
      if (absl::Status wanted = proceed(); !wanted.ok()) return wanted;
      if (!WithinLimits(source.scene(), shelf.limits, diagnostics)) return nullptr;
      scene = SceneFromProto(source.scene(), diagnostics);
      break;
    case v1::SceneSource::kName:
      scene = LoadNamed(source.name(), shelf, proceed, diagnostics);
      break;
    case v1::SceneSource::SOURCE_NOT_SET:
      return MakeFieldError("scene", "missing; give a name (scenes/{scene}) or a scene");
  }
  if (absl::Status wanted = proceed(); !wanted.ok()) return wanted;
  return scene;
}

}  // namespace flatlight
