// SPDX-License-Identifier: Apache-2.0
#include "server/convert/scene_convert.h"

#include <string>

#include "server/convert/describe_scene.h"
#include "server/convert/follow_ups.h"
#include "server/convert/scene_reader.h"
#include "server/convert/unknown_fields.h"

namespace flatlight {
namespace {

// Adds what `earlier` does not explain.
void AddNews(const Diagnostics& found, const FollowUps& earlier, Diagnostics& diagnostics) {
  for (const Diagnostic& mistake : found.kept()) {
    if (!earlier.MayExplain(mistake.path)) diagnostics.Add(mistake.path, mistake.message);
  }
}

}  // namespace

std::shared_ptr<const Scene> SceneFromProto(const v1::Scene& proto, Diagnostics& diagnostics) {
  // More mistakes than anybody is shown: those of meaning would be guesswork.
  if (diagnostics.count() > Diagnostics::kMaxKept) return nullptr;
  // Nothing was read: all that is missing is a consequence.
  if (!diagnostics.empty() && proto.ByteSizeLong() == 0) return nullptr;
  Diagnostics of_form;
  ReportUnknownFields(proto, "", of_form);
  const SceneDescription description = DescribeScene(proto, of_form);
  AddNews(of_form, FollowUps(proto, diagnostics), diagnostics);
  if (!proto.has_plane() || diagnostics.count() > Diagnostics::kMaxKept) return nullptr;
  if (diagnostics.empty()) return BuildScene(description, diagnostics);
  Diagnostics of_meaning;
  BuildScene(description, of_meaning);
  AddNews(of_meaning, FollowUps(proto, diagnostics), diagnostics);
  return nullptr;
}

std::shared_ptr<const Scene> SceneFromJson(std::string_view json, v1::Scene& proto, Diagnostics& diagnostics) {
  ReadSceneJson(json, proto, diagnostics);
  return SceneFromProto(proto, diagnostics);
}

}  // namespace flatlight
