// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/scene_input.h"

#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>

#include <cmath>
#include <cstdint>
#include <memory>

#include "core/scene/diagnostic.h"
#include "core/scene/scene.h"
#include "flatlight/v1/scene.pb.h"
#include "flatlight/v1/scene_service.pb.h"
#include "server/convert/scene_convert.h"
#include "server/convert/scene_reader.h"

namespace flatlight {
namespace {

// A few bytes can ask for a million points; those tell no more than these.
constexpr std::uint64_t kMostPoints = 20000;

std::string CheckDiagnostics(const Diagnostics& diagnostics) {
  v1::ValidateSceneResponse response;
  for (const Diagnostic& mistake : diagnostics.kept()) {
    if (mistake.path.empty() || mistake.message.empty()) return "a mistake without path or message";
    if (mistake.path.size() > 500 || mistake.message.size() > 1000) return "an endless message: " + mistake.path;
    for (const char c : mistake.path + mistake.message) {
      if (static_cast<unsigned char>(c) < ' ') return "a control character in: " + mistake.path;
    }
    v1::Diagnostic& diagnostic = *response.add_diagnostics();
    diagnostic.set_path(mistake.path);
    diagnostic.set_message(mistake.message);
  }
  // Strings that are not UTF-8 are refused by whoever receives them.
  v1::ValidateSceneResponse received;
  return received.ParseFromString(response.SerializeAsString()) ? "" : "a message that is not UTF-8";
}

std::string CheckRoundTrip(const v1::Scene& scene) {
  std::string json;
  if (!google::protobuf::util::MessageToJsonString(scene, &json).ok()) return "protobuf cannot print what was read";
  v1::Scene again;
  Diagnostics diagnostics;
  if (!ReadSceneJson(json, again, diagnostics)) return "refused after printing: " + diagnostics.kept()[0].path;
  return google::protobuf::util::MessageDifferencer::Equals(scene, again) ? "" : "changed by printing and reading";
}

bool IsFinite(double x) { return std::isfinite(x); }

std::string CheckScene(const Scene& scene) {
  for (const Element& element : scene.elements()) {
    const double slack = 1 + 1e-9;
    for (const Point2 p : {element.a, element.b}) {
      if (!(std::abs(p.x) <= slack && std::abs(p.y) <= slack)) return "an element outside the normalised square";
    }
    if (!(element.length > 0) || !IsFinite(element.length)) return "an element without a finite length";
  }
  for (const Probe& probe : scene.probes()) {
    for (const Receiver& receiver : probe.receivers) {
      if (!IsFinite(receiver.position.x) || !IsFinite(receiver.position.y)) return "a receiver that is nowhere";
      if (!(std::abs(Length(receiver.normal) - 1) < 1e-9)) return "a receiver whose normal is not a unit vector";
    }
  }
  return "";
}

}  // namespace

std::string TestSceneInput(std::string_view bytes) {
  v1::Scene proto;
  Diagnostics diagnostics;
  const bool read = ReadSceneJson(bytes, proto, diagnostics);
  if (read != diagnostics.empty()) return "the reader's verdict contradicts its mistakes";
  if (read) {
    if (std::string problem = CheckRoundTrip(proto); !problem.empty()) return problem;
  }
  std::uint64_t points = 0;
  for (const v1::Probe& probe : proto.probes()) points += probe.count();
  if (points > kMostPoints) return CheckDiagnostics(diagnostics);
  const std::shared_ptr<const Scene> scene = SceneFromProto(proto, diagnostics);
  if ((scene != nullptr) != diagnostics.empty()) return "a scene together with mistakes, or neither";
  if (scene != nullptr) return CheckScene(*scene);
  return CheckDiagnostics(diagnostics);
}

}  // namespace flatlight
